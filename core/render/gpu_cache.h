/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes and textures in OpenGL memory, found by content. */
#ifndef PNB_GPU_CACHE_H
#define PNB_GPU_CACHE_H

#include "../gl/gl.h"
#include "../scene/scene.h"

/* One drawn instance, as common_instance.glsl reads it. Attributes and not a storage buffer, which a software renderer
 * reads component by component. */
struct instance_block {
    float rows[3][4]; /* object to relative world */
    float receives;          /* 1 or 0 */
    float hidden;            /* 1 = holdout, 0.5 = shadow catcher */
    uint32_t unlit_by[2];    /* scene_instance.unlit_by, low and high half */
};

/* What every cached object begins with. */
struct gpu_entry {
    struct content_key key;
    uint64_t last_frame;
    uint64_t bytes;
};

struct gpu_mesh {
    struct gpu_entry entry;
    GLuint vertex_array, vertex_buffer, index_buffer;
    struct mesh_range *ranges;
    uint32_t range_count;
    enum { CLOSED_UNKNOWN, CLOSED_NO, CLOSED_YES } closed; /* see gpu_cache_is_closed */
};

struct gpu_image {
    struct gpu_entry entry;
    GLuint texture;
};

struct gpu_cache;

/* Entries of one kind, by key, with open addressing; NULL: free. */
struct gpu_table {
    struct gpu_entry **entries;
    uint32_t capacity, count;
    void (*release)(struct gpu_cache *cache, struct gpu_entry *entry);
};

struct gpu_cache {
    const struct gl *gl;
    GLuint instance_buffer; /* attributes 3 to 7 of every vertex array: instance_block */
    struct gpu_table meshes, images;
    uint64_t frame, bytes;
};

void gpu_cache_init(struct gpu_cache *cache, const struct gl *gl, GLuint instance_buffer);
void gpu_cache_free(struct gpu_cache *cache);
/* What is looked up from now on belongs to a new frame. */
void gpu_cache_begin_frame(struct gpu_cache *cache);
/* Looks up or uploads. The result stays valid until an evict after a frame that did not use it. */
pnb_result gpu_cache_mesh(struct gpu_cache *cache, const pnb_mesh *mesh, const struct gpu_mesh **out);
/* mesh_is_closed of a mesh that was looked up in this frame; what it finds is kept. */
bool gpu_cache_is_closed(struct gpu_cache *cache, const pnb_mesh *mesh);
pnb_result gpu_cache_image(struct gpu_cache *cache, const pnb_texture *texture, const struct gpu_image **out);
/* Frees what the last few frames did not use. */
void gpu_cache_evict(struct gpu_cache *cache);

#endif
