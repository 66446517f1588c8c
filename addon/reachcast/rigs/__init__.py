# SPDX-License-Identifier: GPL-3.0-or-later
"""What a rig is, for any skeleton: plain arrays in and out, no Blender.

joints.py        the 27 joint centres
bone_map.py      which bone of a rig is which segment of a body
rig_presets.py   maps of known rigs and the user's own, and which fits
rig_shape.py     which bone is which by the skeleton's shape, for bones with unknown names
rigify_controls.py  the controls of a generated Rigify rig
implied_bones.py clavicles for rigs without
skeleton.py      a rig's rest pose: its joints, its body frame
rotations.py     rotation maths on stacks of matrices
retarget.py      joints over time -> turn, place and key values of every bone; and forward again: the native module's
"""
