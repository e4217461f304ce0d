/* SPDX-License-Identifier: GPL-3.0-or-later
 * Turns jobs into images. Lives on the context's OpenGL thread; owns every OpenGL object. */
#ifndef PNB_RENDERER_H
#define PNB_RENDERER_H

#include "../gl/gl.h"

struct renderer;
struct pnb_job;

/* `gl` must outlive the renderer. */
pnb_result renderer_create(const struct gl *gl, struct renderer **renderer);
void renderer_destroy(struct renderer **renderer);
/* Renders the job's images. On error all images are dropped by the caller; the renderer stays usable unless the
 * result is CONTEXT_LOST. */
pnb_result renderer_run(struct renderer *renderer, struct pnb_job *job);

#endif
