/* SPDX-License-Identifier: GPL-3.0-or-later
 * Whole files. Errors are PNB_ERROR_FILE and name the path. */
#ifndef PNB_FILE_H
#define PNB_FILE_H

#include "../error.h"

/* Opens a regular file for reading and tells its size. */
pnb_result file_open(const char *path, int *descriptor, uint64_t *size);
/* Reads the next `size` bytes. */
pnb_result file_read(int descriptor, const char *path, void *data, size_t size);
/* Puts a file with this content at `path`, replacing one that is there; on failure everything is as before. */
pnb_result file_replace(const char *path, const void *data, size_t size);

#endif
