/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu_cache.h"
#include "../memory.h"
#include "../scene/mesh.h"

#include <stddef.h>
#include <string.h>

/* Frames an unused mesh or texture is kept: an undo or a toggled eye brings it back at no cost. */
#define KEPT_FRAMES 8

static bool keys_equal(const struct content_key *a, const struct content_key *b) {
    return a->words[0] == b->words[0] && a->words[1] == b->words[1];
}

/* Where the entry of this key is, or would be. */
static struct gpu_entry **table_slot(const struct gpu_table *table, const struct content_key *key) {
    uint32_t i = (uint32_t)key->words[0] & (table->capacity - 1);
    while (table->entries[i] && !keys_equal(&table->entries[i]->key, key))
        i = (i + 1) & (table->capacity - 1);
    return &table->entries[i];
}

/* Moves the entries of the last few frames to a table of this capacity and releases the others. */
static pnb_result table_rebuild(struct gpu_cache *cache, struct gpu_table *table, uint32_t capacity, uint64_t oldest) {
    struct gpu_table rebuilt = {.capacity = capacity, .release = table->release};
    rebuilt.entries = memory_array(capacity, sizeof(struct gpu_entry *));
    if (!rebuilt.entries)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < table->capacity; i++) {
        struct gpu_entry *entry = table->entries[i];
        if (!entry)
            continue;
        if (entry->last_frame >= oldest) {
            *table_slot(&rebuilt, &entry->key) = entry;
            rebuilt.count++;
        } else {
            cache->bytes -= entry->bytes;
            table->release(cache, entry);
        }
    }
    memory_free(table->entries);
    *table = rebuilt;
    return PNB_OK;
}

/* The slot of a key, with room for one more entry: the table is at most half full. */
static pnb_result table_find(struct gpu_cache *cache, struct gpu_table *table, const struct content_key *key,
                             struct gpu_entry ***slot) {
    if (2 * (table->count + 1) > table->capacity) {
        pnb_result result = table_rebuild(cache, table, table->capacity ? 2 * table->capacity : 64, 0);
        if (result != PNB_OK)
            return result;
    }
    *slot = table_slot(table, key);
    if (**slot)
        (**slot)->last_frame = cache->frame;
    return PNB_OK;
}

static void table_add(struct gpu_cache *cache, struct gpu_table *table, struct gpu_entry **slot,
                      struct gpu_entry *entry) {
    entry->last_frame = cache->frame;
    cache->bytes += entry->bytes;
    table->count++;
    *slot = entry;
}

static void table_evict(struct gpu_cache *cache, struct gpu_table *table) {
    const uint64_t oldest = cache->frame > KEPT_FRAMES ? cache->frame - KEPT_FRAMES : 0;
    for (uint32_t i = 0; i < table->capacity; i++)
        if (table->entries[i] && table->entries[i]->last_frame < oldest) {
            /* Without memory for it the next frame tries again. */
            table_rebuild(cache, table, table->capacity, oldest);
            return;
        }
}

static void table_free(struct gpu_cache *cache, struct gpu_table *table) {
    for (uint32_t i = 0; i < table->capacity; i++)
        if (table->entries[i])
            table->release(cache, table->entries[i]);
    memory_free(table->entries);
}

/* ---- Meshes ---- */

static void mesh_release(struct gpu_cache *cache, struct gpu_entry *entry) {
    struct gpu_mesh *mesh = (struct gpu_mesh *)entry;
    const struct gl *gl = cache->gl;
    gl->DeleteVertexArrays(1, &mesh->vertex_array);
    gl->DeleteBuffers(1, &mesh->vertex_buffer);
    gl->DeleteBuffers(1, &mesh->index_buffer);
    memory_free(mesh->ranges);
    memory_free(mesh);
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
    attribute(gl, 8, 3, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(struct vertex, color));
    gl->BindBuffer(GL_ELEMENT_ARRAY_BUFFER, mesh->index_buffer);
    gl->BufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(from->index_count * sizeof(uint32_t)), from->indices,
                   GL_STATIC_DRAW);
    gl->BindBuffer(GL_ARRAY_BUFFER, cache->instance_buffer);
    for (GLuint i = 0; i < 4; i++) {
        gl->EnableVertexAttribArray(3 + i);
        gl->VertexAttribPointer(3 + i, i < 3 ? 4 : 2, GL_FLOAT, GL_FALSE, sizeof(struct instance_block),
                                (const void *)(uintptr_t)(4 * sizeof(float) * i));
        gl->VertexAttribDivisor(3 + i, 1);
    }
    gl->EnableVertexAttribArray(7);
    gl->VertexAttribIPointer(7, 2, GL_UNSIGNED_INT, sizeof(struct instance_block),
                             (const void *)offsetof(struct instance_block, unlit_by));
    gl->VertexAttribDivisor(7, 1);
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
    const uint64_t bytes = from->vertex_count * sizeof(struct vertex) + from->index_count * sizeof(uint32_t);
    *mesh = (struct gpu_mesh){.entry = {.key = from->content, .bytes = bytes},
                              .ranges = ranges,
                              .range_count = from->range_count};
    mesh_upload(cache, from, mesh);
    pnb_result result = gl_check(cache->gl, "mesh upload");
    if (result == PNB_OK) {
        *out = mesh;
        return PNB_OK;
    }
    mesh_release(cache, &mesh->entry);
    if (result == PNB_ERROR_OUT_OF_MEMORY)
        return error_set(result, "out of OpenGL memory for mesh '%s'", from->name);
    return result;
}

pnb_result gpu_cache_mesh(struct gpu_cache *cache, const pnb_mesh *mesh, const struct gpu_mesh **out) {
    struct gpu_entry **slot;
    pnb_result result = table_find(cache, &cache->meshes, &mesh->content, &slot);
    if (result == PNB_OK && !*slot) {
        struct gpu_mesh *created = NULL;
        if ((result = mesh_create(cache, mesh, &created)) == PNB_OK)
            table_add(cache, &cache->meshes, slot, &created->entry);
    }
    if (result == PNB_OK)
        *out = (const struct gpu_mesh *)*slot;
    return result;
}

bool gpu_cache_is_closed(struct gpu_cache *cache, const pnb_mesh *mesh) {
    struct gpu_entry **slot;
    if (table_find(cache, &cache->meshes, &mesh->content, &slot) != PNB_OK || !*slot)
        return false;
    struct gpu_mesh *kept = (struct gpu_mesh *)*slot;
    if (kept->closed == CLOSED_UNKNOWN)
        kept->closed = mesh_is_closed(mesh) ? CLOSED_YES : CLOSED_NO;
    return kept->closed == CLOSED_YES;
}

/* ---- Images ---- */

static void image_release(struct gpu_cache *cache, struct gpu_entry *entry) {
    cache->gl->DeleteTextures(1, &((struct gpu_image *)entry)->texture);
    memory_free(entry);
}

static pnb_result image_create(struct gpu_cache *cache, const pnb_texture *from, struct gpu_image **out) {
    const struct gl *gl = cache->gl;
    struct gpu_image *image = memory_array(1, sizeof *image);
    if (!image)
        return PNB_ERROR_OUT_OF_MEMORY;
    image->entry.key = from->content;
    image->entry.bytes = (uint64_t)from->width * from->height * 8 * 4 / 3; /* with mip maps */
    GLsizei levels = 1;
    for (uint32_t side = from->width > from->height ? from->width : from->height; side > 1; side /= 2)
        levels++;
    gl->GenTextures(1, &image->texture);
    gl->ActiveTexture(GL_TEXTURE0);
    gl->BindTexture(GL_TEXTURE_2D, image->texture);
    const GLsizei width = (GLsizei)from->width, height = (GLsizei)from->height;
    gl->TexStorage2D(GL_TEXTURE_2D, levels, GL_RGBA16F, width, height);
    gl->TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_FLOAT, from->rgba);
    gl->GenerateMipmap(GL_TEXTURE_2D);
    const bool nearest = from->flags & PNB_TEXTURE_NEAREST;
    const GLint wrap = from->flags & PNB_TEXTURE_CLIP     ? GL_CLAMP_TO_BORDER
                       : from->flags & PNB_TEXTURE_EXTEND ? GL_CLAMP_TO_EDGE
                       : from->flags & PNB_TEXTURE_MIRROR ? GL_MIRRORED_REPEAT
                                                          : GL_REPEAT;
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, nearest ? GL_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, nearest ? GL_NEAREST : GL_LINEAR);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap);
    gl->TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap);
    pnb_result result = gl_check(gl, "texture upload");
    if (result == PNB_OK) {
        *out = image;
        return PNB_OK;
    }
    image_release(cache, &image->entry);
    return result == PNB_ERROR_OUT_OF_MEMORY ? error_set(result, "out of OpenGL memory for texture '%s'", from->name)
                                             : result;
}

pnb_result gpu_cache_image(struct gpu_cache *cache, const pnb_texture *texture, const struct gpu_image **out) {
    struct gpu_entry **slot;
    pnb_result result = table_find(cache, &cache->images, &texture->content, &slot);
    if (result == PNB_OK && !*slot) {
        struct gpu_image *created = NULL;
        if ((result = image_create(cache, texture, &created)) == PNB_OK)
            table_add(cache, &cache->images, slot, &created->entry);
    }
    if (result == PNB_OK)
        *out = (const struct gpu_image *)*slot;
    return result;
}

/* ---- Cache ---- */

void gpu_cache_init(struct gpu_cache *cache, const struct gl *gl, GLuint instance_buffer) {
    *cache = (struct gpu_cache){.gl = gl,
                                .instance_buffer = instance_buffer,
                                .meshes = {.release = mesh_release},
                                .images = {.release = image_release}};
}

void gpu_cache_begin_frame(struct gpu_cache *cache) {
    cache->frame++;
}

void gpu_cache_evict(struct gpu_cache *cache) {
    table_evict(cache, &cache->meshes);
    table_evict(cache, &cache->images);
}

void gpu_cache_free(struct gpu_cache *cache) {
    table_free(cache, &cache->meshes);
    table_free(cache, &cache->images);
    *cache = (struct gpu_cache){0};
}
