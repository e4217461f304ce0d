/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fitting of shadow-map views. A view covers the map coordinates where a caster can stand between the emitter and a
 * receiver: for each caster, its own bounds cut with the receivers' bounds grown by the largest penumbra kernel that
 * caster can have. */
#include "light.h"

#include <float.h>
#include <math.h>

/* A perspective view wider than this half-width in q (68 degrees) is split into the faces of a cube. */
#define SINGLE_VIEW_LIMIT 2.5f
/* Faces of a split view reach this far over the 45 degree border, for kernels that cross it. */
#define FACE_LIMIT 1.5f
/* Nearest plane, as a share of the farthest: closer casters would need kernels wider than the view. */
#define NEAREST 1e-4f

/* Rotations from the emitter's frame: right, up and forward of the faces +Z +X -X +Y -Y -Z. */
static const struct {
    int axis[3], sign;
} faces[MAX_LIGHT_VIEWS] = {{{0, 1, 2}, 1}, {{1, 2, 0}, 1},  {{2, 1, 0}, -1},
                            {{2, 0, 1}, 1}, {{0, 2, 1}, -1}, {{1, 0, 2}, -1}};

struct range {
    vec2 minimum, maximum; /* of q; empty when minimum > maximum */
    float near_depth, far_depth;
};

static const struct range empty_range = {{FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX}, FLT_MAX, -FLT_MAX};

static void range_add(struct range *range, const float q[2]) {
    for (int i = 0; i < 2; i++) {
        range->minimum[i] = fminf(range->minimum[i], q[i]);
        range->maximum[i] = fmaxf(range->maximum[i], q[i]);
    }
}

static bool range_is_empty(const struct range *range) {
    return !(range->minimum[0] < range->maximum[0] && range->minimum[1] < range->maximum[1]);
}

static void range_clip(struct range *range, const vec2 minimum, const vec2 maximum) {
    for (int i = 0; i < 2; i++) {
        range->minimum[i] = fmaxf(range->minimum[i], minimum[i]);
        range->maximum[i] = fminf(range->maximum[i], maximum[i]);
    }
}

static void range_union(struct range *range, const struct range *other) {
    range_add(range, other->minimum);
    range_add(range, other->maximum);
    range->near_depth = fminf(range->near_depth, other->near_depth);
    range->far_depth = fmaxf(range->far_depth, other->far_depth);
}

void hull_of_box(const struct box *box, struct hull *hull) {
    for (int corner = 0; corner < 8; corner++)
        for (int i = 0; i < 3; i++)
            hull->corners[corner][i] = (corner >> i) & 1 ? box->maximum[i] : box->minimum[i];
}

/* Range of a hull seen from a view, within +-limit. A perspective view sees only what is before the emitter; a hull
 * that reaches behind it may appear anywhere. */
static struct range hull_range(const struct hull *hull, const struct light_view *view, float limit) {
    struct range range = empty_range;
    bool behind = false;
    for (int corner = 0; corner < 8; corner++) {
        vec3 point;
        glm_mat4_mulv3((vec4 *)view->from_world, (float *)hull->corners[corner], 1.0f, point);
        range.near_depth = fminf(range.near_depth, point[2]);
        range.far_depth = fmaxf(range.far_depth, point[2]);
        if (view->perspective == 0.0f)
            range_add(&range, point);
        else if (point[2] > 0.0f)
            range_add(&range, (vec2){point[0] / point[2], point[1] / point[2]});
        else
            behind = true;
    }
    if (view->perspective == 0.0f)
        return range;
    if (range.far_depth <= 0.0f)
        return empty_range;
    if (behind) {
        range_add(&range, (vec2){-limit, -limit});
        range_add(&range, (vec2){limit, limit});
    }
    range_clip(&range, (vec2){-limit, -limit}, (vec2){limit, limit});
    range.near_depth = fmaxf(range.near_depth, 0.0f);
    return range_is_empty(&range) ? empty_range : range;
}

/* Whether a spot's cone is narrow enough for one view. */
static bool is_narrow_spot(const struct emitter *emitter) {
    return emitter->type == PNB_LIGHT_SPOT && emitter->cos_cone > 0.37f &&
           fmaxf(emitter->cone_scale[0], emitter->cone_scale[1]) < 1.01f;
}

/* Where in a view of this limit a hull of receivers can be lit. Those of a cube face lie within 45 degrees; its map
 * reaches further, for their kernels. Those of a spot lie in its cone, whose tip may lie beside the view's centre. */
static float receiver_limit(const struct emitter *emitter, float limit, float near_depth) {
    if (limit == FACE_LIMIT)
        return 1.0f;
    if (!is_narrow_spot(emitter))
        return limit;
    const float tangent = sqrtf(1.0f - emitter->cos_cone * emitter->cos_cone) / emitter->cos_cone;
    return 1.01f * tangent + (1.0f + tangent) * emitter->cone_offset / fmaxf(near_depth, 1e-6f);
}

static struct range receivers_range(const struct emitter *emitter, const struct hull *hulls, size_t count,
                                    const struct light_view *view, float limit) {
    struct range sum = empty_range;
    for (size_t i = 0; i < count; i++) {
        struct range range = hull_range(&hulls[i], view, limit);
        const float lit = receiver_limit(emitter, limit, range.near_depth);
        range_clip(&range, (vec2){-lit, -lit}, (vec2){lit, lit});
        if (!range_is_empty(&range))
            range_union(&sum, &range);
    }
    return sum;
}

/* Largest extent of the kernel in q for a blocker at depth `blocker` before a receiver at depth `receiver`
 * (DESIGN: w n (1/z_b - 1/z_r) on the near plane, 2 tan(angle/2) (z_r - z_b) for the sun). */
static float kernel_extent(const struct emitter *emitter, float blocker, float receiver) {
    if (emitter->type == PNB_LIGHT_SUN)
        return emitter->tan_half_angle * fmaxf(receiver - blocker, 0.0f);
    const float u = glm_vec3_norm((float *)emitter->half_u), v = glm_vec3_norm((float *)emitter->half_v);
    const float half = emitter->type == PNB_LIGHT_AREA ? u + v : 1.5f * emitter->radius;
    return half * fmaxf(1.0f / fmaxf(blocker, 1e-6f) - 1.0f / fmaxf(receiver, 1e-6f), 0.0f);
}

/* Whether a hull lies behind an emitter that shines to one side only. */
static bool is_behind(const struct hull *hull, const struct emitter *emitter) {
    for (int corner = 0; corner < 8; corner++) {
        vec3 point;
        glm_vec3_sub((float *)hull->corners[corner], (float *)emitter->position, point);
        if (emitter->type != PNB_LIGHT_AREA || glm_vec3_dot(point, (float *)emitter->frame[2]) > 0.0f)
            return false;
    }
    return true;
}

/* What the map must show: see the top of this file. */
static struct range needed_range(const struct emitter *emitter, const struct light_view *view,
                                 const struct range *receivers, const struct box *casters, size_t caster_count,
                                 float limit) {
    struct range needed = empty_range;
    for (size_t i = 0; i < caster_count; i++) {
        struct hull caster;
        hull_of_box(&casters[i], &caster);
        struct range range = hull_range(&caster, view, limit);
        if (range_is_empty(&range) || range.near_depth >= receivers->far_depth || is_behind(&caster, emitter))
            continue;
        const float nearest = fmaxf(range.near_depth, NEAREST * receivers->far_depth);
        const float margin = kernel_extent(emitter, emitter->type == PNB_LIGHT_SUN ? range.near_depth : nearest,
                                           receivers->far_depth);
        range_clip(&range, (vec2){receivers->minimum[0] - margin, receivers->minimum[1] - margin},
                   (vec2){receivers->maximum[0] + margin, receivers->maximum[1] + margin});
        if (!range_is_empty(&range))
            range_union(&needed, &range);
    }
    return needed;
}

/* Sets the view's rectangle and depth range; false if no caster can shadow a receiver in it. */
static bool view_fit(struct light_view *view, const struct emitter *emitter, const struct hull *receivers,
                     size_t receiver_count, const struct box *casters, size_t caster_count, int map_size, float limit) {
    const struct range seen = receivers_range(emitter, receivers, receiver_count, view, limit);
    if (range_is_empty(&seen))
        return false;
    const struct range needed = needed_range(emitter, view, &seen, casters, caster_count, limit);
    if (range_is_empty(&needed))
        return false;
    /* Half a percent and two texels around, so that no tap of an edge pixel falls off the map. */
    vec2 extent;
    for (int i = 0; i < 2; i++) {
        const float width = fmaxf(needed.maximum[i] - needed.minimum[i], 1e-6f);
        const float margin = width * (0.005f + 2.0f / (float)map_size);
        extent[i] = width + 2.0f * margin;
        view->rect[i] = needed.minimum[i] - margin;
        view->rect[i + 2] = 1.0f / extent[i];
    }
    view->texel = fmaxf(extent[0], extent[1]) / (float)map_size;
    const float depth = fmaxf(seen.far_depth - needed.near_depth, 1e-6f * fabsf(seen.far_depth));
    view->far_depth = seen.far_depth + 0.01f * depth;
    view->near_depth = needed.near_depth - 0.01f * depth;
    if (view->perspective != 0.0f)
        view->near_depth = fmaxf(fmaxf(view->near_depth, 0.5f * needed.near_depth), NEAREST * view->far_depth);
    return true;
}

static void view_init(struct light_view *view, const struct emitter *emitter, int face) {
    const bool sun = emitter->type == PNB_LIGHT_SUN;
    *view = (struct light_view){.perspective = sun ? 0.0f : 1.0f};
    glm_mat4_identity(view->from_world);
    for (int row = 0; row < 3; row++) {
        vec3 axis;
        glm_vec3_scale((float *)emitter->frame[faces[face].axis[row]], row == 2 ? (float)faces[face].sign : 1.0f, axis);
        for (int column = 0; column < 3; column++)
            view->from_world[column][row] = axis[column];
        view->from_world[3][row] = sun ? 0.0f : -glm_vec3_dot(axis, (float *)emitter->position);
    }
}

/* Widest q of the receivers from the front: decides between one view and the faces of a cube. */
static bool one_view_suffices(const struct emitter *emitter, const struct hull *receivers, size_t count) {
    if (emitter->type == PNB_LIGHT_SUN)
        return true;
    if (emitter->type == PNB_LIGHT_POINT)
        return false;
    if (is_narrow_spot(emitter))
        return true;
    struct light_view front;
    view_init(&front, emitter, 0);
    const struct range range = receivers_range(emitter, receivers, count, &front, 2.0f * SINGLE_VIEW_LIMIT);
    return range_is_empty(&range) || (range.minimum[0] > -SINGLE_VIEW_LIMIT && range.minimum[1] > -SINGLE_VIEW_LIMIT &&
                                      range.maximum[0] < SINGLE_VIEW_LIMIT && range.maximum[1] < SINGLE_VIEW_LIMIT);
}

void light_views_fit(struct light_views *views, const struct emitter *emitter, const struct hull *receivers,
                     size_t receiver_count, const struct box *casters, size_t caster_count, int map_size) {
    *views = (struct light_views){.single = one_view_suffices(emitter, receivers, receiver_count)};
    views->clip_behind = emitter->type == PNB_LIGHT_AREA && !views->single;
    glm_vec4((float *)emitter->frame[2], -glm_vec3_dot((float *)emitter->frame[2], (float *)emitter->position),
             views->front);
    const int face_count = views->single ? 1 : emitter->type == PNB_LIGHT_POINT ? 6 : 5;
    for (int face = 0; face < MAX_LIGHT_VIEWS; face++) {
        views->layer_of_face[face] = -1;
        if (face >= face_count)
            continue;
        struct light_view *view = &views->views[views->count];
        view_init(view, emitter, face);
        if (view_fit(view, emitter, receivers, receiver_count, casters, caster_count, map_size,
                     !views->single ? FACE_LIMIT : emitter->type == PNB_LIGHT_SUN ? FLT_MAX : SINGLE_VIEW_LIMIT))
            views->layer_of_face[face] = views->count++;
    }
}

/* Texels this much wider than they need be still serve. */
#define WIDEST_TEXEL 1.5f
/* Of the margins of view_fit, half may be missing, so that rounding decides nothing. */
#define MARGIN       0.005f
/* What a loosened view shows around what it must, as shares of its extent. */
#define ROOM_ASIDE   0.05f
#define ROOM_BEHIND  0.2f

static bool view_covers(const struct light_view *before, const struct light_view *view, int map_size) {
    bool covers = before->texel <= WIDEST_TEXEL * view->texel;
    for (int i = 0; i < 2; i++) {
        const float extent = 1.0f / view->rect[i + 2], slack = 0.5f * extent * (MARGIN + 1.0f / (float)map_size);
        covers = covers && before->rect[i] <= view->rect[i] + slack &&
                 before->rect[i] + 1.0f / before->rect[i + 2] >= view->rect[i] + extent - slack;
    }
    const float slack = MARGIN * (view->far_depth - view->near_depth);
    return covers && before->near_depth <= view->near_depth + slack && before->far_depth >= view->far_depth - slack;
}

void light_views_move(struct light_views *views, const vec3 origin, const vec3 other) {
    for (int i = 0; i < views->count; i++) {
        struct light_view *view = &views->views[i];
        vec3 step;
        for (int axis = 0; axis < 3; axis++)
            step[axis] = (float)((double)origin[axis] - (double)other[axis]);
        glm_mat4_mulv3(view->from_world, step, 0.0f, step);
        for (int axis = 0; axis < 3; axis++)
            view->from_world[3][axis] += step[axis];
        view->rect[0] += step[0];
        view->rect[1] += step[1];
        view->near_depth += step[2];
        view->far_depth += step[2];
    }
}

void light_views_loosen(struct light_views *views) {
    for (int i = 0; i < views->count; i++) {
        struct light_view *view = &views->views[i];
        for (int axis = 0; axis < 2; axis++) {
            const float extent = 1.0f / view->rect[axis + 2];
            view->rect[axis] -= ROOM_ASIDE * extent;
            view->rect[axis + 2] = 1.0f / (extent * (1.0f + 2.0f * ROOM_ASIDE));
        }
        view->texel *= 1.0f + 2.0f * ROOM_ASIDE;
        view->far_depth += ROOM_BEHIND * (view->far_depth - view->near_depth);
    }
}

bool light_views_cover(const struct light_views *before, const struct light_views *views, int map_size) {
    bool covers = before->count == views->count && before->single == views->single;
    for (int face = 0; face < MAX_LIGHT_VIEWS && covers; face++)
        covers = before->layer_of_face[face] == views->layer_of_face[face];
    for (int i = 0; i < views->count && covers; i++)
        covers = view_covers(&before->views[i], &views->views[i], map_size);
    return covers;
}

void light_views_take_maps(struct light_views *views, const struct light_views *before) {
    for (int i = 0; i < views->count; i++) {
        struct light_view fitted = before->views[i];
        glm_mat4_copy(views->views[i].from_world, fitted.from_world);
        views->views[i] = fitted;
    }
}

void light_view_projection(const struct light_view *view, mat4 projection) {
    const float n = view->near_depth, f = view->far_depth;
    glm_mat4_zero(projection);
    for (int i = 0; i < 2; i++) { /* 2 uv - 1 */
        projection[i][i] = 2.0f * view->rect[i + 2];
        projection[view->perspective != 0.0f ? 2 : 3][i] = -2.0f * view->rect[i] * view->rect[i + 2] - 1.0f;
    }
    if (view->perspective != 0.0f) {
        projection[2][2] = (f + n) / (f - n);
        projection[2][3] = 1.0f;
        projection[3][2] = -2.0f * f * n / (f - n);
    } else {
        projection[2][2] = 2.0f / (f - n);
        projection[3][2] = -(f + n) / (f - n);
        projection[3][3] = 1.0f;
    }
}
