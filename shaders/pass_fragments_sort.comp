// SPDX-License-Identifier: GPL-3.0-or-later
// Sorts each list by depth, in place (Shell 1959 with Knuth's gaps: an insertion sort while lists are short).
#include "common_fragments.glsl"

layout(local_size_x = 64) in;
uniform uint head_count;
uniform uint most; // fragments of a list that are kept, 0: all

struct entry {
    uint words[FRAGMENT_WORDS];
};

entry load(uint index) {
    entry e;
    for (uint word = 0u; word < FRAGMENT_WORDS; word++)
        e.words[word] = fragments[FRAGMENT_WORDS * index + word];
    return e;
}

void store(uint index, entry e) {
    for (uint word = 0u; word < FRAGMENT_WORDS; word++)
        fragments[FRAGMENT_WORDS * index + word] = e.words[word];
}

// Equal depths by opacity: the order must not depend on which was drawn first.
bool is_before(entry a, entry b) {
    float depth_a = uintBitsToFloat(a.words[0]), depth_b = uintBitsToFloat(b.words[0]);
    if (depth_a != depth_b)
        return depth_a < depth_b;
#ifdef COLORED
    if (a.words[2] != b.words[2])
        return a.words[2] < b.words[2];
#endif
    return a.words[1] < b.words[1];
}

void insert(uint first, uint position, uint gap) {
    entry e = load(first + position);
    while (position >= gap) {
        entry before = load(first + position - gap);
        if (!is_before(e, before))
            break;
        store(first + position, before);
        position -= gap;
    }
    store(first + position, e);
}

void main() {
    uint head = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
    if (head >= head_count)
        return;
    uint first = heads[2u * head], count = heads[2u * head + 1u];
    uint gap = 1u;
    while (3u * gap + 1u < count)
        gap = 3u * gap + 1u;
    for (; gap > 0u; gap /= 3u)
        for (uint position = gap; position < count; position++)
            insert(first, position, gap);
    if (most > 0u)
        heads[2u * head + 1u] = min(count, most);
}
