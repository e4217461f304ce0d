// SPDX-License-Identifier: GPL-3.0-or-later
// Opacity of two fragments one behind the other, as ACCUMULATION says.

const int ADD = 0, MULTIPLY = 1, MAXIMUM = 2;

OPACITY accumulate(OPACITY a, OPACITY b) {
    if (ACCUMULATION == ADD)
        return min(a + b, OPACITY(1.0));
    return ACCUMULATION == MULTIPLY ? 1.0 - (1.0 - a) * (1.0 - b) : max(a, b);
}
