# SPDX-License-Identifier: GPL-3.0-or-later
"""The only code that reads and writes Blender's data.

movers.py          what else than keys moves an object
transforms.py      world transforms of objects, checked
read_rig.py        armature object -> rigs.skeleton.Skeleton
control_rig.py     a motion on a generated Rigify rig's controls
map_editing.py     a bone map edited on the rig, the user's presets
read_task.py       shelf, home and box -> home, target, object in the body frame
action_writer.py   the one file that writes F-curves
write_motion.py    rig pose and box places -> Actions
predict_action.py  predict_motion(): reads, asks the native module, writes
nla_strips.py      Actions on NLA tracks
carry.py           the box in the hands: a hold, a constraint and its influence
measure.py         what the evaluated scene really shows over the frames
"""
