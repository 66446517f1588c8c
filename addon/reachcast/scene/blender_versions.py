# SPDX-License-Identifier: GPL-3.0-or-later
"""Where pictures and exports differ between the versions of Blender: names of engines and settings that came or went."""
from __future__ import annotations

from pathlib import Path

import bpy

_VERSION = bpy.app.version[:2]
#: 4.2 replaced EEVEE: its settings of shadows, occlusion and light probes are gone since. 4.2 to 4.5 call it by a name
#: of its own.
_FIRST_EEVEE = _VERSION < (4, 2)

#: 5.2 draws the font that strips of text have by themselves as nothing once factory settings were read a second time,
#: but not one that is loaded from a file: its own is.
_LOSES_ITS_FONT = _VERSION >= (5, 0)
_FONT = "Inter.woff2"

#: Engines as tasks call them -> as Blender does.
ENGINES = {"EEVEE": "BLENDER_EEVEE_NEXT" if (4, 2) <= _VERSION < (5, 0) else "BLENDER_EEVEE",
           "WORKBENCH": "BLENDER_WORKBENCH", "CYCLES": "CYCLES"}


def set_eevee(scene: bpy.types.Scene, samples: int) -> None:
    """Soft shadows and a little occlusion. Light probes are small: the sky is plain, and they are made for every frame."""
    eevee = scene.eevee
    eevee.taa_render_samples = samples
    if _FIRST_EEVEE:
        eevee.use_soft_shadows, eevee.use_shadow_high_bitdepth = True, True
        eevee.shadow_cascade_size = "2048"
        eevee.use_gtao, eevee.gtao_distance, eevee.gtao_factor = True, 0.35, 1.2
        eevee.gi_cubemap_resolution, eevee.gi_filter_quality = "128", 1.0
        eevee.use_ssr = eevee.use_bloom = eevee.use_motion_blur = False


def set_sun(sun: bpy.types.SunLight, width: float) -> None:
    """width: of the sun in the sky, radians."""
    sun.angle = width
    if _FIRST_EEVEE:
        sun.shadow_cascade_max_distance = 12.0
        sun.use_contact_shadow = True
        sun.contact_shadow_distance, sun.contact_shadow_thickness = 0.06, 0.03


def set_file_format(settings: bpy.types.ImageFormatSettings, form: str) -> None:
    """PNG, OPEN_EXR, ... or FFMPEG, which 5.0 calls another medium."""
    if hasattr(settings, "media_type"):
        settings.media_type = {"FFMPEG": "VIDEO", "OPEN_EXR_MULTILAYER": "MULTI_LAYER_IMAGE"}.get(form, "IMAGE")
    settings.file_format = form


def one_gltf_animation() -> dict[str, object]:
    """Options of the glTF exporter by which the Actions that objects have now become one animation."""
    if "export_animation_mode" in bpy.ops.export_scene.gltf.get_rna_type().properties:
        return {"export_animation_mode": "ACTIVE_ACTIONS"}
    return {"export_nla_strips": False}


def strips_of(scene: bpy.types.Scene) -> bpy.types.bpy_prop_collection:
    """The strips of the scene's sequencer, which is made; 4.4 gave them another name."""
    editor = scene.sequence_editor_create()
    return editor.strips if hasattr(editor, "strips") else editor.sequences


def add_effect(scene: bpy.types.Scene, kind: str, channel: int, length: int) -> bpy.types.Strip:
    """A strip that begins at frame 1 and is `length` frames long, which 5.0 asks for instead of the end."""
    until = {"length": length} if _VERSION >= (5, 0) else {"frame_end": 1 + length}
    return strips_of(scene).new_effect(name=kind.capitalize(), type=kind, channel=channel, frame_start=1, **until)


def add_caption(scene: bpy.types.Scene, text: str, channel: int, length: int) -> bpy.types.Strip:
    """A strip of text that begins at frame 1 and whose place is that of its lower left corner."""
    strip = add_effect(scene, "TEXT", channel, length)
    strip.text = text
    if _LOSES_ITS_FONT:
        fonts = Path(bpy.utils.system_resource("DATAFILES", path="fonts"))
        strip.font = bpy.data.fonts.load(str(fonts / _FONT), check_existing=True)
    if hasattr(strip, "anchor_x"):
        strip.anchor_x, strip.anchor_y, strip.alignment_x = "LEFT", "BOTTOM", "LEFT"
    else:
        strip.align_x, strip.align_y = "LEFT", "BOTTOM"
    return strip
