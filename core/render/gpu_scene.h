/* SPDX-License-Identifier: GPL-3.0-or-later
 * The scene in OpenGL memory: meshes and textures keyed by content, so that each crosses once however often the host
 * makes it, instances as one buffer, and the list of draws. */
#ifndef PNB_GPU_SCENE_H
#define PNB_GPU_SCENE_H

#include "frame.h"

struct gpu_scene;

pnb_result gpu_scene_create(const struct gl *gl, struct gpu_scene **scene);
void gpu_scene_destroy(struct gpu_scene **scene);

/* Uploads what is new in the frame's scene, fills frame->casters, and frees what no frame used for a while. */
pnb_result gpu_scene_update(struct gpu_scene *scene, struct frame *frame);

/* Finds, once a frame, the instances whose mesh is closed and stops light everywhere. `from`: the update's scene. */
void gpu_scene_find_solids(struct gpu_scene *scene, const struct scene *from);

/* Bytes of OpenGL memory it holds. */
uint64_t gpu_scene_bytes(const struct gpu_scene *scene);

/* What a pass draws: what the camera sees, every material that casts shadows, or those that light shines through. */
enum casters { CASTERS_NONE, CASTERS_ALL, CASTERS_TRANSLUCENT };

/* Programs for materials that are one opaque colour and for all others; uniforms of the pass are set beforehand. A pass
 * over casters needs `special` only for what light shines through, or where faces are left out. */
struct draw_programs {
    GLuint plain, special;
    enum casters casters;
    uint32_t cull;           /* the enum pnb_material_flags that hides back faces in this pass */
    bool back_faces;         /* of solid bodies only the back faces; after gpu_scene_find_solids */
};

/* Draws every instance inside the view volume of `clip` (relative world to clip space) that lacks the flag
 * `hidden_by` and the bits `unshadowed_by`. */
pnb_result gpu_scene_draw(struct gpu_scene *scene, const mat4 clip, uint32_t hidden_by, uint64_t unshadowed_by,
                          const struct draw_programs *programs);

/* Nearest and farthest distance along the camera's axis of the visible instances, within the clip planes. */
void gpu_scene_depth_range(const struct gpu_scene *scene, const struct camera_block *camera, float range[2]);

#endif
