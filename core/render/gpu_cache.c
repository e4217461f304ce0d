/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu_cache.h"
#include "../memory.h"

#include <stddef.h>
#include <string.h>

/* Frames an unused mesh or texture is kept: an undo or a toggled eye brings it back at no cost. */
#define KEPT_FRAMES 8

void gpu_cache_init(struct gpu_cache *cache, const struct gl *gl, GLuint instance_buffer) {
    *cache = (struct gpu_cache){.gl = gl, .instance_buffer = instance_buffer};
}

void gpu_cache_begin_frame(struct gpu_cache *cache) {
    cache->frame++;
}

static bool keys_equal(const struct content_key *a, const struct content_key *b) {
    return a->words[0] == b->words[0] && a->words[1] == b->words[1];
}

/* Every entry begins with its key, so that both tables share the probing. */
static uint32_t probe(void *const *table, uint32_t capacity, const struct content_key *key) {
    uint32_t i = (uint32_t)key->words[0] & (capacity - 1);
    while (table[i] && !keys_equal(table[i], key))
        i = (i + 1) & (capacity - 1);
    return i;
}

/* Keeps a table at most half full. */
static pnb_result table_reserve(void ***table, uint32_t *capacity, uint32_t count) {
    if (2 * (count + 1) <= *capacity)
        return PNB_OK;
    const uint32_t grown = *capacity ? 2 * *capacity : 64;
    void **entries = memory_array(grown, sizeof *entries);
    if (!entries)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < *capacity; i++)
        if ((*table)[i])
            entries[probe(entries, grown, (*table)[i])] = (*table)[i];
    memory_free(*table);
    *table = entries;
    *capacity = grown;
    return PNB_OK;
}

static void mesh_free(struct gpu_cache *cache, struct gpu_mesh *mesh) {
    const struct gl *gl = cache->gl;
    gl->DeleteVertexArrays(1, &mesh->vertex_array);
    gl->DeleteBuffers(1, &mesh->vertex_buffer);
    gl->DeleteBuffers(1, &mesh->index_buffer);
    memory_free(mesh->ranges);
    memory_free(mesh);
}

static void image_free(struct gpu_cache *cache, struct gpu_image *image) {
    cache->gl->DeleteTextures(1, &image->texture);
    memory_free(image);
}

static void attribute(const struct gl *gl, GLuint index, GLint size, GLenum type, GLboolean normalized, size_t offset) {
    gl->EnableVertexAttribArray(index);
    gl->VertexAttribPointer(index, size, type, normalized, sizeof(struct vertex), (const void *)offset);
}

/* Attributes as common_instance.glsl declares them. */
static void mesh_upload(struct gpu_cache *cache, const pnb_mesh *from, struct gpu_mesh *mesh) {
    const struct gl *gl = cache->gl;
    gl->GenVertexArrays(1, &mesh->vertex_array);
    gl->GenBuffers(1, &mesh->vertex_buffer);
    gl->GenBuffers(1, &mesh->index_buffer);
    gl->BindVertexArray(mesh->vertex_array);
    gl->BindBuffer(GL_ARRAY_BUFFER, mesh->vertex_buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(from->vertex_count * sizeof(struct vertex)), from->vertices,
                   GL_STATIC_DRAW);
    attribute(gl, 0, 3, GL_FLOAT, GL_FALSE, offsetof(struct vertex, position));
    attribute(gl, 1, 2, GL_SHORT, GL_TRUE, offsetof(struct vertex, normal));
    attribute(gl, 2, 2, GL_FLOAT, GL_FALSE, offsetof(struct vertex, uv));
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->index_buffer);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(from->index_count * sizeof(uint32_t)), from->indices,
                   GL_STATIC_DRAW);
    gl->BindBuffer(GL_ARRAY_BUFFER, cache->instance_buffer);
    for (GLuint i = 0; i < 4; i++) {
        gl->EnableVertexAttribArray(3 + i);
        gl->VertexAttribPointer(3 + i, i < 3 ? 4 : 1, GL_FLOAT, GL_FALSE, sizeof(struct instance_block),
                                (const void *)(uintptr_t)(4 * sizeof(float) * i));
        gl->VertexAttribDivisor(3 + i, 1);
    }
    gl->BindVertexArray(0);
}

static pnb_result mesh_create(struct gpu_cache *cache, const pnb_mesh *from, struct gpu_mesh **out) {
    struct gpu_mesh *mesh = memory_array(1, sizeof *mesh);
    struct mesh_range *ranges = memory_array(from->range_count, sizeof *ranges);
    if (!mesh || !ranges) {
        memory_free(mesh);
        memory_free(ranges);
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    memcpy(ranges, from->ranges, from->range_count * sizeof *ranges);
    *mesh = (struct gpu_mesh){.key = from->content,
                              .bytes = from->vertex_count * sizeof(struct vertex) + from->index_count * sizeof(uint32_t),
                              .ranges = ranges,
                              .range_count = from->range_count};
    mesh_upload(cache, from, mesh);
    pnb_result result = gl_check(cache->gl, "mesh upload");
    if (result == PNB_OK) {
        *out = mesh;
        return PNB_OK;
    }
    mesh_free(cache, mesh);
    return result == PNB_ERROR_OUT_OF_MEMORY ? error_set(result, "out of OpenGL memory for mesh '%s'", from->name) : result;
}

pnb_result gpu_cache_mesh(struct gpu_cache *cache, const pnb_mesh *mesh, const struct gpu_mesh **out) {
    pnb_result result = table_reserve((void ***)&cache->meshes, &cache->mesh_capacity, cache->mesh_count);
    if (result != PNB_OK)
        return result;
    struct gpu_mesh **slot = &cache->meshes[probe((void *const *)cache->meshes, cache->mesh_capacity, &mesh->content)];
    if (!*slot) {
        struct gpu_mesh *created = NULL;
        if ((result = mesh_create(cache, mesh, &created)) != PNB_OK)
            return result;
        *slot = created;
        cache->mesh_count++;
        cache->bytes += created->bytes;
    }
    (*slot)->last_frame = cache->frame;
    *out = *slot;
    return PNB_OK;
}

static pnb_result image_create(struct gpu_cache *cache, const pnb_texture *from, struct gpu_image **out) {
    const struct gl *gl = cache->gl;
    struct gpu_image *image = memory_array(1, sizeof *image);
    if (!image)
        return PNB_ERROR_OUT_OF_MEMORY;
    image->key = from->content;
    image->bytes = (uint64_t)from->width * from->height * 8 * 4 / 3;
    GLsizei levels = 1;
    for (uint32_t side = from->width > from->height ? from->width : from->height; side > 1; side /= 2)
        levels++;
    gl->GenTextures(1, &image->texture);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, image->texture);
    gl->TexStorage2D(GL_TEXTURE_2D, levels, GL_RGBA16F, (GLsizei)from->width, (GLsizei)from->height);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, (GLsizei)from->width, (GLsizei)from->height, GL_RGBA, GL_FLOAT, from->rgba);
    gl->GenerateMipmap(GL_TEXTURE_2D);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    pnb_result result = gl_check(gl, "texture upload");
    if (result == PNB_OK) {
        *out = image;
        return PNB_OK;
    }
    image_free(cache, image);
    return result == PNB_ERROR_OUT_OF_MEMORY ? error_set(result, "out of OpenGL memory for texture '%s'", from->name)
                                             : result;
}

pnb_result gpu_cache_image(struct gpu_cache *cache, const pnb_texture *texture, const struct gpu_image **out) {
    pnb_result result = table_reserve((void ***)&cache->images, &cache->image_capacity, cache->image_count);
    if (result != PNB_OK)
        return result;
    struct gpu_image **slot =
        &cache->images[probe((void *const *)cache->images, cache->image_capacity, &texture->content)];
    if (!*slot) {
        struct gpu_image *created = NULL;
        if ((result = image_create(cache, texture, &created)) != PNB_OK)
            return result;
        *slot = created;
        cache->image_count++;
        cache->bytes += created->bytes;
    }
    (*slot)->last_frame = cache->frame;
    *out = *slot;
    return PNB_OK;
}

/* Open addressing cannot just clear a slot: the entries that stay are put back into the emptied table. */
static void table_rebuild(void **table, uint32_t capacity, void **kept, uint32_t count) {
    memset(table, 0, capacity * sizeof *table);
    for (uint32_t i = 0; i < count; i++)
        table[probe(table, capacity, kept[i])] = kept[i];
}

static bool is_stale(const struct gpu_cache *cache, uint64_t last_frame) {
    return last_frame + KEPT_FRAMES < cache->frame;
}

static void evict_meshes(struct gpu_cache *cache) {
    uint32_t stale = 0, count = 0;
    for (uint32_t i = 0; i < cache->mesh_capacity; i++)
        stale += cache->meshes[i] && is_stale(cache, cache->meshes[i]->last_frame);
    void **kept = stale ? memory_array(cache->mesh_count, sizeof *kept) : NULL;
    if (!kept)
        return;
    for (uint32_t i = 0; i < cache->mesh_capacity; i++) {
        struct gpu_mesh *mesh = cache->meshes[i];
        if (mesh && is_stale(cache, mesh->last_frame)) {
            cache->bytes -= mesh->bytes;
            mesh_free(cache, mesh);
        } else if (mesh) {
            kept[count++] = mesh;
        }
    }
    cache->mesh_count = count;
    table_rebuild((void **)cache->meshes, cache->mesh_capacity, kept, count);
    memory_free(kept);
}

static void evict_images(struct gpu_cache *cache) {
    uint32_t stale = 0, count = 0;
    for (uint32_t i = 0; i < cache->image_capacity; i++)
        stale += cache->images[i] && is_stale(cache, cache->images[i]->last_frame);
    void **kept = stale ? memory_array(cache->image_count, sizeof *kept) : NULL;
    if (!kept)
        return;
    for (uint32_t i = 0; i < cache->image_capacity; i++) {
        struct gpu_image *image = cache->images[i];
        if (image && is_stale(cache, image->last_frame)) {
            cache->bytes -= image->bytes;
            image_free(cache, image);
        } else if (image) {
            kept[count++] = image;
        }
    }
    cache->image_count = count;
    table_rebuild((void **)cache->images, cache->image_capacity, kept, count);
    memory_free(kept);
}

void gpu_cache_evict(struct gpu_cache *cache) {
    evict_meshes(cache);
    evict_images(cache);
}

void gpu_cache_free(struct gpu_cache *cache) {
    for (uint32_t i = 0; i < cache->mesh_capacity; i++)
        if (cache->meshes[i])
            mesh_free(cache, cache->meshes[i]);
    for (uint32_t i = 0; i < cache->image_capacity; i++)
        if (cache->images[i])
            image_free(cache, cache->images[i]);
    memory_free(cache->meshes);
    memory_free(cache->images);
    *cache = (struct gpu_cache){0};
}
