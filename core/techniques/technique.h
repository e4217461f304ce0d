/* SPDX-License-Identifier: GPL-3.0-or-later
 * A technique is one row of techniques[] (table.c), one C file with its parameters and one GLSL file with
 * `vec3 technique_visibility(receiver)`. The row is all there is to know: validation, user interfaces, the tool, the
 * documents and the tests are driven by it. */
#ifndef PNB_TECHNIQUE_H
#define PNB_TECHNIQUE_H

#include "../render/frame.h"

struct parameter {
    const char *name, *label, *description, *unit;
    pnb_parameter_type type;
    double minimum, maximum, default_value;
    const char *const *items; /* ENUM: identifiers, NULL-terminated */
};

/* What the shared passes must prepare of each shadow map before the technique's visibility pass. */
enum technique_needs {
    NEEDS_MIN_MAX = 1,     /* the pyramid of least and greatest depth */
    NEEDS_ALL_CASTERS = 2  /* the map holds the nearest fragment, however transparent */
};

/* Parameter of a technique whose shader has `vec2 technique_extent(receiver r)`, the rectangle that holds its taps
 * (negative: decide nothing), and that yields 1 or 0 where nothing or everything in it blocks. If it is on, tiles of
 * the image that are decided by the min-max pyramid are not drawn by the technique. */
#define SKIP_PARAMETER "min_max"

/* Parameter of a technique that, if it is on, is drawn at every other pixel of both axes and interpolated in between
 * where neighbours show one surface in much the same light: subsampling.c. Not together with SKIP_PARAMETER. */
#define SUBSAMPLING_PARAMETER "subsampling"

struct technique {
    const char *id, *label, *description, *paper;
    const struct parameter *parameters; /* ends with a NULL name; each is a uniform `p_<name>` of the shader */
    uint32_t needs;                     /* enum technique_needs */
    const char *shader;                 /* file of technique_visibility; NULL with `draw` */
    /* Optional: sample points for the shader's taps (common_taps.glsl) for a light whose emitter is elliptic or not;
     * sample: index of the anti-aliasing sample, of `samples` in all. */
    void (*taps)(const double *parameters, bool ellipse, uint32_t sample, uint32_t samples, struct taps *taps);
    /* Optional: #define lines for the shader, a static string: what should be constant, since a software renderer
     * executes both sides of every branch. */
    const char *(*defines)(const double *parameters);
    /* Optional: makes light->prefiltered of the light's shadow map and, with NEEDS_MIN_MAX, its pyramid; once, before
     * the anti-aliasing samples. */
    pnb_result (*prefilter)(struct frame *frame, struct frame_light *light);
    uint32_t prefilter_bytes; /* of those textures, per texel of a shadow map, at most */
    /* Optional: gives the shader's program, which is current, what it reads besides parameters, taps, shadow_map and
     * min_max. Texture units from `unit` on are free. */
    void (*bind)(struct frame *frame, const struct frame_light *light, GLuint program, int unit);
    /* Optional: draws visibility itself instead of shadow maps and one visibility pass. */
    pnb_result (*draw)(struct frame *frame, const struct frame_light *light);
};

extern const struct technique *const techniques[]; /* ends with NULL */

/* By identifier, in any case; NULL if there is none. */
const struct technique *technique_find(const char *id);
/* Place in the table. */
int technique_index(const struct technique *technique);
/* Index of a parameter by name, -1 if there is none. */
int technique_parameter(const struct technique *technique, const char *name);
/* Whether the SKIP_PARAMETER is there and on. */
bool technique_skips(const struct technique *technique, const double *parameters);

/* Whether the SUBSAMPLING_PARAMETER is there and on. */
bool technique_subsamples(const struct technique *technique, const double *parameters);

#endif
