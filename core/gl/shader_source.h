/* SPDX-License-Identifier: GPL-3.0-or-later
 * The files of shaders/, embedded at build time. */
#ifndef PNB_SHADER_SOURCE_H
#define PNB_SHADER_SOURCE_H

struct shader_source {
    const char *name; /* file name without folder; NULL ends the table */
    const char *text;
};

extern const struct shader_source shader_sources[];

#endif
