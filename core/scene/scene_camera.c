/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "axes.h"
#include "numbers.h"
#include "scene_parts.h"

#include <string.h>

#define DEFAULT_CLIP_START 0.1f
#define DEFAULT_CLIP_END   1000.0f

/* Half the width of the default window: 36 mm at 50 mm, or 6 m. */
static float default_half_width(pnb_projection projection) {
    return projection == PNB_PERSPECTIVE ? 0.36f : 3.0f;
}

static void window_set(float window[4], float half_width, float half_height) {
    window[0] = -half_width;
    window[1] = half_width;
    window[2] = -half_height;
    window[3] = half_height;
}

static void camera_resolve_matrix(struct scene_camera *camera, struct messages *messages) {
    float *matrix = camera->matrix;
    if (!numbers_usable(matrix, 16) || !numbers_within(matrix + 12, 3, LARGEST_COORDINATE)) {
        messages_add(messages, "camera: its matrix is not finite or leads too far away; it looks down from the origin "
                               "instead");
        memset(matrix, 0, sizeof camera->matrix);
    } else if (axes_complete(matrix)) {
        messages_add(messages, "camera: its matrix is singular (a scale of 0?); the missing axes are made up");
    }
    axes_complete(matrix);
    const float side = axes_determinant(matrix) < 0 ? -1.0f : 1.0f;
    axes_orthonormalize(matrix);
    for (int i = 0; i < 3; i++)
        matrix[i] *= side;
    matrix_make_affine(matrix);
}

static void camera_resolve_window(struct scene_camera *camera, struct messages *messages) {
    float *window = camera->window;
    camera->window_is_default = window[0] == 0 && window[1] == 0 && window[2] == 0 && window[3] == 0;
    bool good = numbers_usable(window, 4) && window[1] > window[0] && window[3] > window[2];
    if (!good && !camera->window_is_default) {
        messages_add(messages, "camera: its window of %g..%g x %g..%g is empty; the default is used", (double)window[0],
                     (double)window[1], (double)window[2], (double)window[3]);
        camera->window_is_default = true;
    }
    if (camera->window_is_default) {
        float half = default_half_width(camera->projection);
        window_set(window, half, half);
    }
}

static void camera_resolve_clip(struct scene_camera *camera, struct messages *messages) {
    float start = camera->clip_start != 0 ? camera->clip_start : DEFAULT_CLIP_START;
    float end = camera->clip_end != 0 ? camera->clip_end : DEFAULT_CLIP_END;
    if (!(start > 0) || !numbers_usable((float[]){start, end}, 2) || !(end > start)) {
        messages_add(messages, "camera: it cannot clip to %g..%g m; %g..%g m is used", (double)start, (double)end,
                     (double)DEFAULT_CLIP_START, (double)DEFAULT_CLIP_END);
        start = DEFAULT_CLIP_START;
        end = DEFAULT_CLIP_END;
    }
    camera->clip_start = start;
    camera->clip_end = end;
}

void camera_resolve(const pnb_camera *from, struct messages *messages, struct scene_camera *to) {
    *to = (struct scene_camera){
        .projection = from->projection, .clip_start = from->clip_start, .clip_end = from->clip_end};
    memcpy(to->matrix, from->matrix, sizeof to->matrix);
    memcpy(to->window, from->window, sizeof to->window);
    camera_resolve_matrix(to, messages);
    camera_resolve_window(to, messages);
    camera_resolve_clip(to, messages);
}

void scene_camera_fit(struct scene_camera *camera, uint32_t width, uint32_t height) {
    if (camera->window_is_default && width > 0 && height > 0) {
        float half = default_half_width(camera->projection);
        window_set(camera->window, half, half * (float)height / (float)width);
    }
}
