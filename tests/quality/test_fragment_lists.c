/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fragment lists and their filtered levels against lists made and merged here, texel by texel: count, depth, opacity
 * and order of the base, every level of MIP map and Y-map for each way of accumulating; and what filters are for: one
 * opaque texel becomes as wide as its level, centred, and no opacity is lost. */
#include "pass_bench.h"

#include "memory.h"

#define SIDE   64
#define MOST   256 /* fragments of one texel */
#define SHEETS 40

/* A horizontal sheet over whole texels of the map: x0 <= x < x1 and so on, at a depth. */
struct sheet {
    int x0, y0, x1, y1;
    float depth, opacity;
};

struct fragment {
    float depth, opacity;
};

struct list {
    int count;
    struct fragment fragments[MOST];
};

struct lists {
    int side, border;
    struct list *texels;
};

struct stage {
    pnb_mesh *meshes[SHEETS];
    pnb_instance instances[SHEETS];
    pnb_material materials[2 * SHEETS]; /* two to an instance, whose slots they are */
    uint32_t slots[2 * SHEETS];
    struct sheet sheets[SHEETS]; /* what the lists should hold */
    uint32_t count, sheet_count;
};

/* The map covers 0..1 in q, and light space is the world: orthographic. */
static struct light_views stage_views(void) {
    struct light_views views = {.count = 1, .single = true};
    views.views[0] = (struct light_view){
        .rect = {0, 0, 1, 1}, .near_depth = 1, .far_depth = 9, .perspective = 0, .texel = 1.0f / SIDE};
    glm_mat4_identity(views.views[0].from_world);
    return views;
}

/* The instance of a mesh, scaled by 1 or -1 and then moved along x, with two opaque materials. */
static void place(struct stage *stage, uint32_t i, float x, float mirror) {
    stage->instances[i] = (pnb_instance){.struct_size = sizeof(pnb_instance),
                                         .mesh = stage->meshes[i],
                                         .first_slot = 2 * i,
                                         .slot_count = 2,
                                         .matrix = {mirror, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, x, 0, 0, 1}};
    for (uint32_t slot = 2 * i; slot < 2 * i + 2; slot++) {
        stage->materials[slot] = (pnb_material){.struct_size = sizeof(pnb_material)};
        stage->slots[slot] = slot;
    }
}

static void add_sheet(struct stage *stage, struct sheet sheet) {
    const float x0 = (float)sheet.x0 / SIDE, x1 = (float)sheet.x1 / SIDE, y0 = (float)sheet.y0 / SIDE,
                y1 = (float)sheet.y1 / SIDE, z = sheet.depth;
    const float positions[] = {x0, y0, z, x1, y0, z, x1, y1, z, x0, y1, z};
    const uint32_t triangles[] = {0, 1, 2, 0, 2, 3}, i = stage->count++;
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    desc.vertex_count = desc.corner_count = 4;
    desc.triangle_count = 2;
    desc.positions.data = positions;
    desc.triangles.data = triangles;
    CHECK_RESULT(pnb_mesh_create(&desc, &stage->meshes[i]), PNB_OK);
    place(stage, i, 0, 1);
    stage->materials[2 * i].transparency = 1 - sheet.opacity;
    stage->sheets[stage->sheet_count++] = sheet;
}

static void stage_free(struct stage *stage) {
    for (uint32_t i = 0; i < stage->count; i++)
        pnb_mesh_destroy(&stage->meshes[i]);
    *stage = (struct stage){0};
}

/* ---- The oracle ---- */

static void lists_create(struct lists *lists, int side, int border) {
    *lists = (struct lists){side, border, calloc((size_t)side * (size_t)side, sizeof *lists->texels)};
    if (!lists->texels)
        exit(1);
}

static int by_depth(const void *a, const void *b) {
    const struct fragment *first = a, *second = b;
    return first->depth < second->depth ? -1 : first->depth > second->depth;
}

static void base_lists(const struct stage *stage, struct lists *lists) {
    lists_create(lists, SIDE, 0);
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct list *list = &lists->texels[i];
        for (uint32_t s = 0; s < stage->sheet_count; s++) {
            const struct sheet *sheet = &stage->sheets[s];
            if (i % SIDE >= sheet->x0 && i % SIDE < sheet->x1 && i / SIDE >= sheet->y0 && i / SIDE < sheet->y1)
                list->fragments[list->count++] = (struct fragment){sheet->depth, sheet->opacity};
        }
        qsort(list->fragments, (size_t)list->count, sizeof *list->fragments, by_depth);
    }
}

static float accumulate(int mode, float a, float b) {
    return mode == 0 ? fminf(a + b, 1) : mode == 1 ? 1 - (1 - a) * (1 - b) : fmaxf(a, b);
}

/* Selgrad et al. 2015, figure 3. */
static void merge(const struct list *sources[4], float tolerance, int mode, struct list *to) {
    int next[4] = {0};
    to->count = 0;
    for (;;) {
        float nearest = INFINITY, opacity = 0;
        for (int s = 0; s < 4; s++)
            if (next[s] < sources[s]->count)
                nearest = fminf(nearest, sources[s]->fragments[next[s]].depth);
        if (isinf(nearest) || to->count == MOST)
            return;
        double sum = 0;
        int merged = 0;
        for (int s = 0; s < 4; s++) {
            float own = 0;
            for (; next[s] < sources[s]->count && sources[s]->fragments[next[s]].depth <= nearest + tolerance;
                 next[s]++) {
                sum += (double)sources[s]->fragments[next[s]].depth;
                own = accumulate(mode, own, sources[s]->fragments[next[s]].opacity);
                merged++;
            }
            opacity += own / 4;
        }
        to->fragments[to->count++] = (struct fragment){(float)(sum / merged), opacity};
    }
}

static const struct list *list_at(const struct lists *lists, int x, int y) {
    static const struct list empty;
    const bool inside = x >= 0 && y >= 0 && x < lists->side && y < lists->side;
    return inside ? &lists->texels[y * lists->side + x] : &empty;
}

/* The texels of a level that texel `x` merges: two of a MIP map, or of a stack those on both sides of its place. */
static void sources_of(const struct fragment_level *level, const struct lists *below, int x, int sources[2]) {
    const int place = x - level->border;
    if (level->stack == 0) {
        sources[0] = 2 * x;
        sources[1] = 2 * x + 1;
    } else if (level->stack == 1) {
        sources[0] = place - 1;
        sources[1] = place;
    } else {
        sources[0] = place - (1 << (level->stack - 2)) + below->border;
        sources[1] = place + (1 << (level->stack - 2)) + below->border;
    }
}

static void merge_level(const struct fragment_level *level, const struct lists *below, float tolerance, int mode,
                        struct lists *lists) {
    lists_create(lists, level->side, level->border);
    for (int i = 0; i < level->side * level->side; i++) {
        int x[2], y[2];
        sources_of(level, below, i % level->side, x);
        sources_of(level, below, i / level->side, y);
        const struct list *sources[4] = {list_at(below, x[0], y[0]), list_at(below, x[1], y[0]),
                                         list_at(below, x[0], y[1]), list_at(below, x[1], y[1])};
        merge(sources, tolerance, mode, &lists->texels[i]);
    }
}

/* ---- What OpenGL made ---- */

static void read_level(const struct gl *gl, const struct fragment_lists *from, uint32_t index, struct lists *to) {
    const struct fragment_level *level = &from->levels[index];
    const size_t texels = (size_t)level->side * (size_t)level->side;
    uint32_t *heads = malloc(texels * 8);
    struct fragment *fragments = malloc(from->count * sizeof *fragments + 1);
    lists_create(to, level->side, level->border);
    if (!heads || !fragments)
        exit(1);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, from->heads.id);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 8 * (GLintptr)level->first_head, (GLsizeiptr)(8 * texels), heads);
    gl->BindBuffer(GL_SHADER_STORAGE_BUFFER, from->fragments.id);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, (GLsizeiptr)(from->count * sizeof *fragments), fragments);
    for (size_t i = 0; i < texels; i++) {
        const uint32_t first = heads[2 * i], count = heads[2 * i + 1];
        if (count > MOST || (uint64_t)first + count > from->count) {
            CHECK(false);
            continue;
        }
        to->texels[i].count = (int)count;
        memcpy(to->texels[i].fragments, fragments + first, count * sizeof *fragments);
    }
    free(heads);
    free(fragments);
}

/* Number of lists that are not the expected ones. */
static int differences(const struct lists *expected, const struct lists *found) {
    int wrong = 0;
    for (int i = 0; i < expected->side * expected->side; i++) {
        const struct list *a = &expected->texels[i], *b = &found->texels[i];
        bool good = a->count == b->count;
        for (int f = 0; good && f < a->count; f++)
            /* Sums of single precision: depths to a part in a million, opacities of up to 4^6 texels likewise. */
            good = fabsf(a->fragments[f].depth - b->fragments[f].depth) <= 1e-5f &&
                   fabsf(a->fragments[f].opacity - b->fragments[f].opacity) <= 1e-6f;
        wrong += !good;
    }
    return wrong;
}

static double total_opacity(const struct lists *lists) {
    double sum = 0;
    for (int i = 0; i < lists->side * lists->side; i++)
        for (int f = 0; f < lists->texels[i].count; f++)
            sum += (double)lists->texels[i].fragments[f].opacity;
    return sum;
}

/* ---- Tests ---- */

static const struct fragment_choice all_casters = {.casters = CASTERS_ALL};

static bool make_lists(struct bench *bench, const struct stage *stage, const struct fragment_choice *choice,
                       const struct fragment_filter *filter, struct fragment_lists *lists) {
    const pnb_scene from = {.struct_size = sizeof from,
                            .instance_count = stage->count,
                            .material_count = 2 * stage->count,
                            .slot_count = 2 * stage->count,
                            .instances = stage->instances,
                            .materials = stage->materials,
                            .slots = stage->slots,
                            .camera = {.struct_size = sizeof(pnb_camera)}};
    struct scene *scene;
    if (!CHECK_RESULT(scene_create(&from, &bench->messages, &scene), PNB_OK))
        return false;
    bench->frame.scene = scene;
    const struct light_views views = stage_views();
    struct gl_texture map = {0};
    CHECK_RESULT(gpu_scene_update(bench->renderer->scene, &bench->frame), PNB_OK);
    CHECK_RESULT(pass_shadow_map(&bench->frame, &views, SIDE, TRANSLUCENCY_ANY, &map), PNB_OK);
    bool good = CHECK_RESULT(pass_fragment_lists(&bench->frame, &views, choice, &map, "test", lists), PNB_OK) &&
                CHECK_RESULT(pass_fragment_filter(&bench->frame, &views, filter, SIDE, "test", lists), PNB_OK);
    gl_texture_free(&bench->backend.gl, &map);
    memory_free(bench->frame.casters);
    bench->frame.casters = NULL;
    bench->frame.caster_count = 0;
    scene_destroy(&scene);
    return good;
}

static uint32_t random_below(uint32_t *state, uint32_t end) {
    return next_random(state) % end;
}

static void random_stage(struct stage *stage) {
    uint32_t random = 5;
    for (int i = 0; i < SHEETS; i++) {
        const int x = (int)random_below(&random, SIDE - 1), y = (int)random_below(&random, SIDE - 1);
        const int width = 1 + (int)random_below(&random, 24), height = 1 + (int)random_below(&random, 24);
        add_sheet(stage,
                  (struct sheet){x, y, x + width < SIDE ? x + width : SIDE, y + height < SIDE ? y + height : SIDE,
                                 1.5f + 0.171f * (float)i, i % 3 == 0 ? 1.0f : 0.1f + 0.02f * (float)i});
    }
}

/* split: fragments need several storage blocks. */
static void levels_match(struct bench *bench, int stack_side, int mode, bool split) {
    struct stage stage = {0};
    struct fragment_lists lists = {0};
    random_stage(&stage);
    const struct fragment_filter filter = {
        .level_count = 6, .stack_side = stack_side, .accumulation = mode, .merge_distance = 2, .light_size = 1e-3f};
    struct lists below, expected, found;
    base_lists(&stage, &below);
    if (make_lists(bench, &stage, &all_casters, &filter, &lists)) {
        read_level(&bench->backend.gl, &lists, 0, &found);
        CHECK_INT(differences(&below, &found), 0);
        free(found.texels);
        for (uint32_t i = 1; i < lists.level_count; i++) {
            const struct fragment_level *level = &lists.levels[i];
            const float tolerance = 2.0f / SIDE * (float)(1 << (level->log2_texel + level->stack));
            merge_level(level, &below, tolerance, mode, &expected);
            read_level(&bench->backend.gl, &lists, i, &found);
            if (!CHECK_INT(differences(&expected, &found), 0))
                printf("  level %u of %u, side %d, stack %d, accumulation %d\n", i, lists.level_count, level->side,
                       level->stack, mode);
            free(below.texels);
            free(found.texels);
            below = expected;
        }
    }
    CHECK_INT(gl_buffer_is_split(&bench->backend.gl, &lists.fragments), split);
    printf("stack from %d, accumulation %d%s: %u levels as merged here\n", stack_side, mode, split ? ", split" : "",
           lists.level_count);
    free(below.texels);
    fragment_lists_free(&bench->backend.gl, &lists);
    stage_free(&stage);
}

/* One opaque texel; its opacity over all texels of a level, and where they are. */
static void one_texel(struct bench *bench, int stack_side) {
    struct stage stage = {0};
    struct fragment_lists lists = {0};
    add_sheet(&stage, (struct sheet){24, 40, 25, 41, 4, 1});
    const struct fragment_filter filter = {
        .level_count = 7, .stack_side = stack_side, .accumulation = 1, .merge_distance = 2, .light_size = 1e-3f};
    if (!make_lists(bench, &stage, &all_casters, &filter, &lists))
        return;
    for (uint32_t i = 0; i < lists.level_count; i++) {
        const struct fragment_level *level = &lists.levels[i];
        const double texel = 1 << level->log2_texel;
        struct lists found;
        read_level(&bench->backend.gl, &lists, i, &found);
        double center[2] = {0, 0}, sum = 0;
        int least = level->side, greatest = -1;
        for (int t = 0; t < level->side * level->side; t++)
            for (int f = 0; f < found.texels[t].count; f++) {
                const double opacity = (double)found.texels[t].fragments[f].opacity;
                const int x = t % level->side, y = t / level->side;
                center[0] += opacity * (x - level->border + (level->stack ? 0.0 : 0.5)) * texel;
                center[1] += opacity * (y - level->border + (level->stack ? 0.0 : 0.5)) * texel;
                sum += opacity;
                least = x < least ? x : least;
                greatest = x > greatest ? x : greatest;
            }
        const int width = level->stack ? 1 << level->stack : 1;
        CHECK_INT(greatest - least + 1, width);
        /* Opacity times area is that of one texel. */
        CHECK_NEAR(sum * texel * texel, 1, 1e-6);
        /* The texel lies anywhere in the texel of the MIP map that holds it, the stack is symmetric about that one. */
        CHECK_AT_MOST(fabs(center[0] / sum - 24.5), texel / 2);
        CHECK_AT_MOST(fabs(center[1] / sum - 40.5), texel / 2);
        const double cell = floor(24 / texel) * texel + texel / 2;
        CHECK_NEAR(center[0] / sum, cell, 1e-6);
        free(found.texels);
    }
    printf("one texel, stack from %d: %u levels centred and as wide as they should be\n", stack_side,
           lists.level_count);
    fragment_lists_free(&bench->backend.gl, &lists);
    stage_free(&stage);
}

/* Sheets side by side: a level's opacity times area stays, whatever is merged. */
static void opacity_is_conserved(struct bench *bench, int mode) {
    struct stage stage = {0};
    struct fragment_lists lists = {0};
    for (int i = 0; i < 32; i++)
        add_sheet(&stage,
                  (struct sheet){i, 2 * (i % 7), i + 1, SIDE - i, 2 + 0.1f * (float)i, 0.5f + 0.01f * (float)i});
    const struct fragment_filter filter = {
        .level_count = 7, .stack_side = 0, .accumulation = mode, .merge_distance = 20, .light_size = 1e-3f};
    if (!make_lists(bench, &stage, &all_casters, &filter, &lists))
        return;
    double base = 0, worst = 0;
    for (uint32_t i = 0; i < lists.level_count; i++) {
        struct lists found;
        read_level(&bench->backend.gl, &lists, i, &found);
        const double total = total_opacity(&found) * (double)(1 << (2 * lists.levels[i].log2_texel));
        base = i == 0 ? total : base;
        /* Adding conserves all; the others only while no list holds two of the merged fragments, in the first level. */
        if (mode == 0 || i <= 1)
            worst = fmax(worst, fabs(total / base - 1));
        free(found.texels);
    }
    printf("accumulation %d: opacity conserved to %.2g\n", mode, worst);
    CHECK(base > 100);
    CHECK_AT_MOST(worst, 1e-5);
    fragment_lists_free(&bench->backend.gl, &lists);
    stage_free(&stage);
}

/* What lies within a distance of the first of several becomes one, before layers are counted. */
static void near_depths_are_joined(struct bench *bench, int mode, uint32_t most) {
    struct stage stage = {0};
    struct fragment_lists lists = {0};
    random_stage(&stage); /* sheets 0.171 apart */
    const struct fragment_choice choice = {
        .casters = CASTERS_ALL, .joined = 0.4f * SIDE, .accumulation = mode, .most = most};
    const struct fragment_filter filter = {.level_count = 1, .merge_distance = 2, .light_size = 1e-3f};
    struct lists base, joined, found;
    base_lists(&stage, &base);
    lists_create(&joined, SIDE, 0);
    static const struct list empty;
    int fewer = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        struct list *list = &joined.texels[i];
        merge((const struct list *[4]){&base.texels[i], &empty, &empty, &empty}, 0.4f, mode, list);
        for (int f = 0; f < list->count; f++)
            list->fragments[f].opacity *= 4; /* of one list instead of four */
        fewer += base.texels[i].count - list->count;
        list->count = most > 0 && list->count > (int)most ? (int)most : list->count;
    }
    CHECK(fewer > SIDE);
    if (make_lists(bench, &stage, &choice, &filter, &lists)) {
        read_level(&bench->backend.gl, &lists, 0, &found);
        CHECK_INT(differences(&joined, &found), 0);
        free(found.texels);
    }
    free(base.texels);
    free(joined.texels);
    fragment_lists_free(&bench->backend.gl, &lists);
    stage_free(&stage);
}

enum body { SOLID, MIRRORED, INSIDE_OUT, OPEN, CLEAR_BACK, CULLED_BACK, BODIES };

#define BODY_SIDE 8 /* texels */

/* A box between the depths 3 and 5, whose far side has the second material. */
static void add_box(struct stage *stage, int x, enum body body) {
    static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    static const int32_t slots[12] = {[10] = 1, [11] = 1};
    float positions[8][3];
    uint32_t triangles[12][3];
    for (uint32_t v = 0; v < 8; v++)
        for (uint32_t axis = 0; axis < 3; axis++)
            positions[v][axis] = axis < 2 ? (float)(v >> axis & 1u) * BODY_SIDE / SIDE : v & 4u ? 5.0f : 3.0f;
    for (uint32_t t = 0; t < 12; t++) {
        const uint32_t *face = faces[t / 2], second = face[1 + t % 2], third = face[2 + t % 2];
        triangles[t][0] = face[0];
        triangles[t][1] = body == INSIDE_OUT ? third : second;
        triangles[t][2] = body == INSIDE_OUT ? second : third;
    }
    const uint32_t i = stage->count++, left_out = body == OPEN ? 2 : 0; /* a side that the light sees edge-on */
    pnb_mesh_desc desc = PNB_INIT(pnb_mesh_desc);
    desc.vertex_count = desc.corner_count = 8;
    desc.triangle_count = 12 - left_out;
    desc.positions.data = positions;
    desc.triangles.data = triangles[left_out];
    desc.polygon_materials.data = slots + left_out;
    CHECK_RESULT(pnb_mesh_create(&desc, &stage->meshes[i]), PNB_OK);
    place(stage, i, (float)(x + (body == MIRRORED ? BODY_SIDE : 0)) / SIDE, body == MIRRORED ? -1 : 1);
    stage->materials[2 * i + 1].transparency = body == CLEAR_BACK ? 0.5f : 0;
    stage->materials[2 * i + 1].flags = body == CULLED_BACK ? PNB_MATERIAL_CULL_SHADOW : 0;
}

/* Front faces are left out of bodies that stop the light at their backs, too, and of no others. */
static void front_faces_are_left_out(struct bench *bench) {
    struct stage stage = {0};
    struct fragment_lists lists = {0};
    for (enum body body = SOLID; body < BODIES; body++) {
        const int x = (BODY_SIDE + 1) * (int)body;
        add_box(&stage, x, body);
        const bool front = body > MIRRORED, back = body != CULLED_BACK;
        if (front)
            stage.sheets[stage.sheet_count++] = (struct sheet){x, 0, x + BODY_SIDE, BODY_SIDE, 3, 1};
        if (back)
            stage.sheets[stage.sheet_count++] =
                (struct sheet){x, 0, x + BODY_SIDE, BODY_SIDE, 5, body == CLEAR_BACK ? 0.5f : 1};
    }
    const struct fragment_filter filter = {.level_count = 1, .merge_distance = 2, .light_size = 1e-3f};
    struct lists expected, found;
    base_lists(&stage, &expected);
    if (make_lists(bench, &stage, &(struct fragment_choice){.casters = CASTERS_ALL, .back_faces = true}, &filter,
                   &lists)) {
        read_level(&bench->backend.gl, &lists, 0, &found);
        CHECK_INT(differences(&expected, &found), 0);
        free(found.texels);
    }
    free(expected.texels);
    fragment_lists_free(&bench->backend.gl, &lists);
    stage_free(&stage);
}

int main(void) {
    quality_open();
    static struct bench bench;
    if (bench_open(&bench)) {
        for (int mode = 0; mode < 3; mode++) {
            levels_match(&bench, 0, mode, false);
            levels_match(&bench, 16, mode, false);
            opacity_is_conserved(&bench, mode);
            near_depths_are_joined(&bench, mode, mode == 0 ? 2 : 0);
        }
        const int64_t limit = bench.backend.gl.max_buffer_size;
        bench.backend.gl.max_buffer_size = 44 << 10; /* blocks of 32 KiB */
        levels_match(&bench, 0, 1, true);
        bench.backend.gl.max_buffer_size = limit;
        front_faces_are_left_out(&bench);
        one_texel(&bench, 0);
        one_texel(&bench, 16);
        bench_close(&bench);
    }
    return quality_close();
}
