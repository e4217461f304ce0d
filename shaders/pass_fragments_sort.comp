// SPDX-License-Identifier: GPL-3.0-or-later
// Sorts each list by depth, in place (Shell 1959 with Knuth's gaps: an insertion sort while lists are short). With JOIN
// surfaces that lie close behind one another become one (Selgrad et al. 2015, section 4.1).
#include "common_fragments.glsl"

layout(local_size_x = 64) in;
uniform uint head_count;
uniform uint most; // fragments of a list that are kept, 0: all
#ifdef JOIN
#include "common_accumulation.glsl"
uniform float distances[6]; // of each view, within which depths are joined: metres, at depth 1 in perspective
uniform int perspective;
uniform uint texels;        // lists of a view
#endif

struct entry {
    uint words[FRAGMENT_WORDS];
};

entry load(uint index) {
    entry e;
    for (uint word = 0u; word < FRAGMENT_WORDS; word++)
        e.words[word] = fragment_word(FRAGMENT_WORDS * index + word);
    return e;
}

void store(uint index, entry e) {
    for (uint word = 0u; word < FRAGMENT_WORDS; word++)
        fragment_set_word(FRAGMENT_WORDS * index + word, e.words[word]);
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

#ifdef JOIN
// Joins what lies within `near` of the first of several; gives the number of fragments left.
uint join(uint first, uint count, float near) {
    uint kept = 0u;
    for (uint i = 0u; i < count;) {
        float base = fragment_depth(first + i), sum = 0.0, joined = 0.0;
        float last = base + near * (perspective == 1 ? base : 1.0);
        OPACITY opacity = OPACITY(0.0);
        for (; i < count && fragment_depth(first + i) <= last; i++) {
            sum += fragment_depth(first + i) - base;
            joined += 1.0;
            opacity = accumulate(opacity, fragment_opacity(first + i));
        }
        fragment_store(first + kept, base + sum / joined, opacity);
        kept++;
    }
    return kept;
}
#endif

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
#ifdef JOIN
    count = join(first, count, distances[head / texels]);
#endif
    heads[2u * head + 1u] = most > 0u ? min(count, most) : count;
}
