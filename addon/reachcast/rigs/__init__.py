# SPDX-License-Identifier: GPL-3.0-or-later
"""Joint centres to bone rotations, for any skeleton: plain arrays in and out, no Blender.

joints.py     the 27 joint centres
bone_map.py   which bone of a rig is which segment of a body
skeleton.py   a rig's rest pose: its joints, its body frame
rotations.py  rotation maths on stacks of matrices
limbs.py      orientations of arms and legs
retarget.py   joints over time -> turn and place of every bone; each bone's own rotation; and forward again
channels.py   rotations -> quaternion, Euler or axis-angle values
"""
