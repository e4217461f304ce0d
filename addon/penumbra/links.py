# SPDX-License-Identifier: GPL-3.0-or-later
"""Light and shadow linking, from Blender 4.0 on: which objects a light lights, and which shadow it."""

from . import capi, compat


class LightLinks:
    """Bits of the lights for each object; bit i is that of light i of the exported scene."""

    def __init__(self):
        self._unlit = []        # (bit, included, excluded): addresses of original objects; included None: all
        self._unshadowed = []

    def add_light(self, index, owner):
        """`owner`: the light's object, or the one that instances it."""
        linking = compat.light_linking(owner.original)
        if linking is None or index >= capi.MAX_LIGHTS:
            return
        for collection, rules in ((linking.receiver_collection, self._unlit),
                                  (linking.blocker_collection, self._unshadowed)):
            if collection:
                rules.append((1 << index, *_members(collection)))

    def __bool__(self):
        return bool(self._unlit or self._unshadowed)

    def of(self, owner):
        """(unlit_by, unshadowed_by) of an object, or of the one that instances it."""
        key = owner.original.as_pointer()
        return _bits(self._unlit, key), _bits(self._unshadowed, key)


def _bits(rules, key):
    bits = 0
    for bit, included, excluded in rules:
        if key in excluded or included is not None and key not in included:
            bits |= bit
    return bits


def _members(collection):
    """(included, excluded); with nothing included all are that are not excluded."""
    included, excluded = set(), set()
    sets = {'INCLUDE': included, 'EXCLUDE': excluded}
    for ob, link in zip(collection.objects, collection.collection_objects):
        sets[link.light_linking.link_state].add(ob.original.as_pointer())
    for child, link in zip(collection.children, collection.collection_children):
        sets[link.light_linking.link_state].update(ob.original.as_pointer() for ob in child.all_objects)
    return included or None, excluded
