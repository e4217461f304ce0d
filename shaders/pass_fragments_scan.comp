// SPDX-License-Identifier: GPL-3.0-or-later
// Makes room for the lists: an exclusive sum of their lengths (Sengupta et al. 2007) within a work group, behind what
// other groups have taken. Sets the lengths to 0, for collecting to count again.
#include "common_fragments.glsl"

layout(local_size_x = 256) in;
layout(std430, binding = 4) buffer cursor_block {
    uint cursor; // end of all lists
};
uniform uint head_count;

const uint RUN = 16u; // lists for each invocation
shared uint sums[256];
shared uint group_first;

void main() {
    uint i = gl_LocalInvocationID.x;
    uint run = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 256u + i;
    uint first = min(run * RUN, head_count), last = min(first + RUN, head_count);
    uint own = 0u;
    for (uint head = first; head < last; head++)
        own += heads[2u * head + 1u];
    sums[i] = own;
    barrier();
    for (uint step = 1u; step < 256u; step *= 2u) {
        uint before = i >= step ? sums[i - step] : 0u;
        barrier();
        sums[i] += before;
        barrier();
    }
    if (i == 255u)
        group_first = atomicAdd(cursor, sums[255]);
    barrier();
    uint place = group_first + sums[i] - own;
    for (uint head = first; head < last; head++) {
        uint count = heads[2u * head + 1u];
        heads[2u * head] = place;
        heads[2u * head + 1u] = 0u;
        place += count;
    }
}
