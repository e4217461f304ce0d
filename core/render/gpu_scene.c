/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "gpu_scene.h"
#include "../gl/program.h"
#include "../memory.h"
#include "gpu_cache.h"

#include <float.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

/* A range of a mesh with one material, for one instance; sorted so that equal draws become one call. */
struct draw {
    const struct gpu_mesh *mesh;
    const struct mesh_range *range;
    uint32_t material, instance;
    bool solid; /* its instance is, once gpu_scene_find_solids has looked */
};

struct gpu_material {
    vec4 base_color; /* rgb, alpha */
    vec4 emission;   /* rgb, 1 = holdout */
    vec4 clearness;  /* rgb, 1 = tinted by base_color_texture */
    float shadow_threshold;
    const struct gpu_image *base_color_texture, *alpha_texture, *emission_texture;
    bool alpha_is_grey, transparent, translucent, textured;
    vec4 uv_rows[2];
    uint32_t flags;
};

struct gpu_scene {
    const struct gl *gl;
    struct gpu_cache cache;
    GLuint instance_buffer; /* instance_block of each drawn instance, in draw order */
    uint32_t instance_count, draw_count, material_count;
    struct instance_block *instances;
    struct box *bounds;      /* per instance, relative world */
    uint32_t *flags;         /* per instance */
    uint64_t *unshadowed_by; /* per instance */
    struct draw *draws;
    bool solids_found; /* of this frame */
    struct gpu_material *materials;
    struct instance_block *visible; /* scratch of gpu_scene_draw: what goes to instance_buffer */
};

pnb_result gpu_scene_create(const struct gl *gl, struct gpu_scene **out) {
    struct gpu_scene *scene = memory_array(1, sizeof *scene);
    if (!scene)
        return PNB_ERROR_OUT_OF_MEMORY;
    scene->gl = gl;
    gl->GenBuffers(1, &scene->instance_buffer);
    gpu_cache_init(&scene->cache, gl, scene->instance_buffer);
    *out = scene;
    return PNB_OK;
}

static void free_frame_data(struct gpu_scene *scene) {
    memory_free(scene->instances);
    memory_free(scene->bounds);
    memory_free(scene->flags);
    memory_free(scene->unshadowed_by);
    memory_free(scene->draws);
    memory_free(scene->materials);
    memory_free(scene->visible);
    scene->instances = scene->visible = NULL;
    scene->bounds = NULL;
    scene->flags = NULL;
    scene->unshadowed_by = NULL;
    scene->draws = NULL;
    scene->materials = NULL;
    scene->instance_count = scene->draw_count = scene->material_count = 0;
    scene->solids_found = false;
}

void gpu_scene_destroy(struct gpu_scene **out) {
    struct gpu_scene *scene = *out;
    if (!scene)
        return;
    free_frame_data(scene);
    gpu_cache_free(&scene->cache);
    scene->gl->DeleteBuffers(1, &scene->instance_buffer);
    memory_free(scene);
    *out = NULL;
}

uint64_t gpu_scene_bytes(const struct gpu_scene *scene) {
    return scene->cache.bytes + scene->draw_count * sizeof(struct instance_block);
}

/* ---- Materials ---- */

static pnb_result load_materials(struct gpu_scene *scene, const struct scene *from) {
    scene->materials = memory_array(from->material_count, sizeof *scene->materials);
    if (!scene->materials)
        return PNB_ERROR_OUT_OF_MEMORY;
    scene->material_count = from->material_count;
    for (uint32_t i = 0; i < from->material_count; i++) {
        const struct scene_material *source = &from->materials[i];
        struct gpu_material *material = &scene->materials[i];
        glm_vec3_copy((float *)source->base_color, material->base_color);
        material->base_color[3] = source->alpha;
        glm_vec3_copy((float *)source->emission, material->emission);
        material->emission[3] = source->flags & PNB_MATERIAL_HOLDOUT ? 1.0f : 0.0f;
        if (!(source->flags & PNB_MATERIAL_OPAQUE_SHADOW))
            glm_vec4((float *)source->clearness, material_is_tinted(source) ? 1.0f : 0.0f, material->clearness);
        material->shadow_threshold = source->shadow_threshold;
        material->flags = source->flags;
        pnb_result result = PNB_OK;
        if (source->base_color_texture)
            result = gpu_cache_image(&scene->cache, source->base_color_texture, &material->base_color_texture);
        if (result == PNB_OK && source->alpha_texture)
            result = gpu_cache_image(&scene->cache, source->alpha_texture, &material->alpha_texture);
        if (result == PNB_OK && source->emission_texture)
            result = gpu_cache_image(&scene->cache, source->emission_texture, &material->emission_texture);
        if (result != PNB_OK)
            return result;
        material->alpha_is_grey = source->alpha_texture && !source->alpha_texture->has_alpha;
        material->transparent = source->alpha < 1.0f || source->alpha_texture;
        material->translucent = material_is_translucent(source);
        material->textured = source->base_color_texture || source->alpha_texture || source->emission_texture ||
                             (source->flags & PNB_MATERIAL_VERTEX_COLOR);
        for (int row = 0; row < 2; row++)
            glm_vec4_copy((vec4){source->uv_matrix[3 * row], source->uv_matrix[3 * row + 1],
                                 source->uv_matrix[3 * row + 2], 0.0f},
                          material->uv_rows[row]);
    }
    return PNB_OK;
}

/* ---- Instances ---- */

/* Object to relative world, in double where a large translation meets a large origin. */
static void relative_rows(const float matrix[16], const vec3 origin, vec4 rows[3]) {
    for (int row = 0; row < 3; row++) {
        for (int column = 0; column < 3; column++)
            rows[row][column] = matrix[4 * column + row];
        rows[row][3] = (float)((double)matrix[12 + row] - (double)origin[row]);
    }
}

/* Bounds of a transformed box, by interval arithmetic (Arvo 1990). */
static struct box transform_box(const float bounds[2][3], vec4 rows[3]) {
    struct box box;
    for (int row = 0; row < 3; row++) {
        float low = rows[row][3], high = rows[row][3];
        for (int column = 0; column < 3; column++) {
            const float a = rows[row][column] * bounds[0][column], b = rows[row][column] * bounds[1][column];
            low += a < b ? a : b;
            high += a < b ? b : a;
        }
        box.minimum[row] = low;
        box.maximum[row] = high;
    }
    return box;
}

static bool box_is_empty(const struct box *box) {
    return !(box->minimum[0] <= box->maximum[0]);
}

static pnb_result load_instances(struct gpu_scene *scene, struct frame *frame) {
    const struct scene *from = frame->scene;
    const uint32_t count = from->instance_count;
    scene->instances = memory_array(count, sizeof *scene->instances);
    scene->bounds = memory_array(count, sizeof *scene->bounds);
    scene->flags = memory_array(count, sizeof *scene->flags);
    scene->unshadowed_by = memory_array(count, sizeof *scene->unshadowed_by);
    frame->casters = memory_array(count, sizeof *frame->casters);
    if (!scene->instances || !scene->bounds || !scene->flags || !scene->unshadowed_by || !frame->casters)
        return PNB_ERROR_OUT_OF_MEMORY;
    scene->instance_count = count;
    for (uint32_t i = 0; i < count; i++) {
        const struct scene_instance *instance = &from->instances[i];
        struct instance_block *block = &scene->instances[i];
        relative_rows(instance->matrix, frame->origin, block->rows);
        block->receives = instance->flags & PNB_INSTANCE_NO_RECEIVE ? 0.0f : 1.0f;
        block->hidden = instance->flags & PNB_INSTANCE_HOLDOUT          ? 1.0f
                        : instance->flags & PNB_INSTANCE_SHADOW_CATCHER ? 0.5f
                                                                        : 0.0f;
        block->unlit_by[0] = (uint32_t)instance->unlit_by;
        block->unlit_by[1] = (uint32_t)(instance->unlit_by >> 32);
        scene->flags[i] = instance->flags;
        scene->unshadowed_by[i] = instance->unshadowed_by;
        scene->bounds[i] = instance->mesh->index_count ? transform_box(instance->mesh->bounds, block->rows)
                                                       : (struct box){{FLT_MAX, 0, 0}, {-FLT_MAX, 0, 0}};
        if (!(instance->flags & PNB_INSTANCE_NO_SHADOW) && !box_is_empty(&scene->bounds[i]))
            frame->casters[frame->caster_count++] = scene->bounds[i];
    }
    return PNB_OK;
}

/* ---- Draws ---- */

static uint32_t material_of(const struct scene *from, const struct scene_instance *instance, uint32_t slot) {
    if (instance->slot_count == 0)
        return from->material_count - 1; /* the default */
    return from->slots[instance->first_slot + (slot < instance->slot_count ? slot : instance->slot_count - 1)];
}

static int compare_pointers(const void *a, const void *b) {
    return (a > b) - (a < b);
}

static int compare_draws(const void *first, const void *second) {
    const struct draw *a = first, *b = second;
    if (a->mesh != b->mesh) /* by content: where depths are equal the first drawn wins, whatever was uploaded before */
        return memcmp(&a->mesh->entry.key, &b->mesh->entry.key, sizeof a->mesh->entry.key);
    if (a->range != b->range)
        return compare_pointers(a->range, b->range);
    if (a->material != b->material)
        return a->material < b->material ? -1 : 1;
    return (a->instance > b->instance) - (a->instance < b->instance);
}

/* Whether light that meets the instance's front meets its back, too: a closed mesh whose faces all stop it. */
static bool is_solid(struct gpu_scene *scene, const struct scene *from, const struct scene_instance *instance) {
    const pnb_mesh *mesh = instance->mesh;
    bool solid = gpu_cache_is_closed(&scene->cache, mesh);
    for (uint32_t r = 0; r < mesh->range_count && solid; r++) {
        const struct gpu_material *material = &scene->materials[material_of(from, instance, mesh->ranges[r].slot)];
        solid = !material->translucent && !(material->flags & (PNB_MATERIAL_NO_SHADOW | PNB_MATERIAL_CULL_SHADOW));
    }
    return solid;
}

static pnb_result load_draws(struct gpu_scene *scene, const struct scene *from) {
    size_t count = 0;
    for (uint32_t i = 0; i < from->instance_count; i++)
        count += from->instances[i].mesh->range_count;
    scene->draws = memory_array(count, sizeof *scene->draws);
    scene->visible = memory_array(count, sizeof *scene->visible);
    if (!scene->draws || !scene->visible)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < from->instance_count; i++) {
        const struct scene_instance *instance = &from->instances[i];
        const struct gpu_mesh *mesh;
        if (instance->mesh->index_count == 0)
            continue;
        pnb_result result = gpu_cache_mesh(&scene->cache, instance->mesh, &mesh);
        if (result != PNB_OK)
            return result;
        for (uint32_t r = 0; r < mesh->range_count; r++)
            scene->draws[scene->draw_count++] =
                (struct draw){mesh, &mesh->ranges[r], material_of(from, instance, mesh->ranges[r].slot), i, false};
    }
    qsort(scene->draws, scene->draw_count, sizeof *scene->draws, compare_draws);
    return PNB_OK;
}

void gpu_scene_find_solids(struct gpu_scene *scene, const struct scene *from) {
    for (uint32_t i = 0; i < scene->draw_count && !scene->solids_found; i++)
        scene->draws[i].solid = is_solid(scene, from, &from->instances[scene->draws[i].instance]);
    scene->solids_found = true;
}

pnb_result gpu_scene_update(struct gpu_scene *scene, struct frame *frame) {
    free_frame_data(scene);
    gpu_cache_begin_frame(&scene->cache);
    pnb_result result;
    if ((result = load_materials(scene, frame->scene)) != PNB_OK || (result = load_instances(scene, frame)) != PNB_OK ||
        (result = load_draws(scene, frame->scene)) != PNB_OK)
        return result;
    gpu_cache_evict(&scene->cache);
    return PNB_OK;
}

/* Whether a box lies wholly outside one of the side planes of a clip volume, or behind its eye. */
static bool box_is_outside(const struct box *box, const mat4 clip) {
    unsigned outside = ~0u;
    for (int corner = 0; corner < 8; corner++) {
        vec4 p = {(corner & 1) ? box->maximum[0] : box->minimum[0], (corner & 2) ? box->maximum[1] : box->minimum[1],
                  (corner & 4) ? box->maximum[2] : box->minimum[2], 1.0f};
        glm_mat4_mulv((vec4 *)clip, p, p);
        outside &= (p[0] < -p[3] ? 1u : 0u) | (p[0] > p[3] ? 2u : 0u) | (p[1] < -p[3] ? 4u : 0u) |
                   (p[1] > p[3] ? 8u : 0u) | (p[2] < -p[3] ? 16u : 0u) | (p[2] > p[3] ? 32u : 0u);
    }
    return outside != 0;
}

/* Which faces a draw leaves out; as common_material.glsl numbers them. */
enum faces { FACES_NONE, FACES_BACK, FACES_FRONT };

static enum faces culled_faces(const struct draw *draw, const struct gpu_material *material,
                               const struct draw_programs *programs) {
    if (material->flags & programs->cull)
        return FACES_BACK;
    return programs->back_faces && draw->solid ? FACES_FRONT : FACES_NONE;
}

/* special: with the program for materials that need more than a base colour. */
static void bind_material(const struct gl *gl, GLuint program, const struct gpu_material *material, bool special,
                          enum faces culled) {
    program_set_vec4(gl, program, "base_color", material->base_color);
    program_set_vec4(gl, program, "emission", material->emission);
    if (!special)
        return;
    program_set_int(gl, program, "culled_faces", (int)culled);
    program_set_vec4(gl, program, "clearness", material->clearness);
    program_set_float(gl, program, "shadow_threshold", material->shadow_threshold);
    const vec4 use = {material->base_color_texture ? 1.0f : 0.0f, material->alpha_texture ? 1.0f : 0.0f,
                      material->alpha_is_grey ? 0.0f : 1.0f, material->emission_texture ? 1.0f : 0.0f};
    program_set_vec4(gl, program, "texture_use", use);
    program_set_vec4(gl, program, "uv_rows[0]", material->uv_rows[0]);
    program_set_vec4(gl, program, "uv_rows[1]", material->uv_rows[1]);
    program_set_int(gl, program, "use_vertex_color", (material->flags & PNB_MATERIAL_VERTEX_COLOR) != 0);
    program_set_int(gl, program, "base_color_texture", 0);
    program_set_int(gl, program, "alpha_texture", 1);
    program_set_int(gl, program, "emission_texture", 2);
    const struct gpu_image *const images[] = {material->base_color_texture, material->alpha_texture,
                                              material->emission_texture};
    for (int unit = 0; unit < 3; unit++) {
        const struct gpu_image *image = images[unit];
        gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
        gl->BindTexture(GL_TEXTURE_2D, image ? image->texture : 0);
    }
}

/* Whether a pass draws a material at all, and whether with the program for special ones. */
static bool is_drawn(const struct gpu_material *material, const struct draw_programs *programs) {
    if (programs->casters != CASTERS_NONE && (material->flags & PNB_MATERIAL_NO_SHADOW))
        return false;
    return programs->casters != CASTERS_TRANSLUCENT || material->translucent;
}

static bool is_special(const struct gpu_material *material, const struct draw_programs *programs) {
    return programs->casters == CASTERS_NONE ? material->transparent || material->textured : material->translucent;
}

static bool is_same_call(const struct draw *a, const struct draw *b) {
    return a->mesh == b->mesh && a->range == b->range && a->material == b->material && a->solid == b->solid;
}

/* A software renderer keeps the triangles of a framebuffer until it is asked for their pixels. Asked before all of them
 * have come, its other threads work beside the one that transforms vertices, and the memory for triangles is used again
 * and again instead of much that is new to the processor, page by page. */
#define MOST_QUEUED_INDICES 15000u

/* Draws a range: in parts, where that does not change what is drawn first. */
static void draw_range(const struct gl *gl, const struct mesh_range *range, GLsizei instances, GLuint first,
                       uint64_t *queued) {
    const uint32_t part = gl->is_software && instances == 1 ? MOST_QUEUED_INDICES : range->index_count;
    for (uint32_t done = 0; done < range->index_count;) {
        const uint32_t left = range->index_count - done, count = left < part ? left : part;
        gl->DrawElementsInstancedBaseInstance(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT,
                                              (const void *)((range->first_index + (uintptr_t)done) * sizeof(uint32_t)),
                                              instances, first);
        done += count;
        *queued += (uint64_t)count * (uint64_t)instances;
        if (gl->is_software && *queued >= MOST_QUEUED_INDICES) {
            gl->Flush();
            *queued = 0;
        }
    }
}

pnb_result gpu_scene_draw(struct gpu_scene *scene, const mat4 clip, uint32_t hidden_by, uint64_t unshadowed_by,
                          const struct draw_programs *programs) {
    const struct gl *gl = scene->gl;
    bool *culled = memory_array(scene->instance_count, sizeof *culled);
    if (!culled)
        return PNB_ERROR_OUT_OF_MEMORY;
    for (uint32_t i = 0; i < scene->instance_count; i++)
        culled[i] = (scene->flags[i] & hidden_by) || (scene->unshadowed_by[i] & unshadowed_by) ||
                    box_is_outside(&scene->bounds[i], clip);
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->draw_count; i++)
        if (!culled[scene->draws[i].instance])
            scene->visible[count++] = scene->instances[scene->draws[i].instance];
    gl->BindBuffer(GL_ARRAY_BUFFER, scene->instance_buffer);
    gl->BufferData(GL_ARRAY_BUFFER, (GLsizeiptr)((count ? count : 1) * sizeof *scene->visible),
                   count ? scene->visible : NULL, GL_STREAM_DRAW);
    GLuint current = 0;
    uint64_t queued = 0;
    for (uint32_t i = 0, base = 0; i < scene->draw_count;) {
        const struct draw *draw = &scene->draws[i];
        GLsizei instances = 0;
        for (; i < scene->draw_count && is_same_call(draw, &scene->draws[i]); i++)
            instances += culled[scene->draws[i].instance] ? 0 : 1;
        const struct gpu_material *material = &scene->materials[draw->material];
        const uint32_t first = base;
        base += (uint32_t)instances;
        if (instances == 0 || !is_drawn(material, programs))
            continue;
        const enum faces faces = culled_faces(draw, material, programs);
        const bool special = is_special(material, programs) || faces != FACES_NONE;
        const GLuint program = special ? programs->special : programs->plain;
        if (program != current)
            gl->UseProgram(program);
        current = program;
        bind_material(gl, program, material, special, faces);
        gl->BindVertexArray(draw->mesh->vertex_array);
        draw_range(gl, draw->range, instances, first, &queued);
    }
    memory_free(culled);
    return gl_check(gl, "drawing the scene");
}

void gpu_scene_depth_range(const struct gpu_scene *scene, const struct camera_block *camera, float range[2]) {
    float low = FLT_MAX, high = -FLT_MAX;
    for (uint32_t i = 0; i < scene->instance_count; i++) {
        if (box_is_empty(&scene->bounds[i]) || (scene->flags[i] & PNB_INSTANCE_HIDDEN_FROM_CAMERA))
            continue;
        for (int corner = 0; corner < 8; corner++) {
            const struct box *box = &scene->bounds[i];
            const vec3 p = {(corner & 1) ? box->maximum[0] : box->minimum[0],
                            (corner & 2) ? box->maximum[1] : box->minimum[1],
                            (corner & 4) ? box->maximum[2] : box->minimum[2]};
            const float depth = -glm_vec3_dot((float *)p, (float *)camera->axis_z);
            low = depth < low ? depth : low;
            high = depth > high ? depth : high;
        }
    }
    /* A thousandth around, so that nothing is cut by rounding. */
    range[0] = glm_max(range[0], low - 1e-3f * fabsf(low));
    range[1] = glm_min(range[1], high + 1e-3f * fabsf(high));
    if (!(range[0] < range[1]))
        range[1] = range[0] + glm_max(1e-3f, 1e-3f * fabsf(range[0]));
}
