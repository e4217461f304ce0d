/* SPDX-License-Identifier: GPL-3.0-or-later
 * Files that appear complete or not at all: written under a temporary name beside the target, then renamed. */
#ifndef OUTPUT_H
#define OUTPUT_H

#include "tool.h"

struct output {
    const char *path;
    char *temporary; /* what the writer writes to */
};

/* Whether a file could be created there, so that a long render does not end in vain; reported if not. */
bool output_check(const char *path);

/* Creates the temporary file. `path` must outlive the output. */
bool output_begin(struct output *output, const char *path);
/* Renames it to the path if `complete`, else removes it. False if anything failed. */
bool output_end(struct output *output, bool complete);

#endif
