/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "frame.h"

void camera_block_init(struct camera_block *block, const struct scene_camera *camera, const struct settings *settings,
                       uint32_t sample) {
    *block = (struct camera_block){.perspective = camera->projection == PNB_PERSPECTIVE ? 1.0f : 0.0f,
                                   .sample_index = (float)sample,
                                   .sample_count = (float)settings->samples};
    for (int i = 0; i < 3; i++) {
        block->axis_x[i] = camera->matrix[i];
        block->axis_y[i] = camera->matrix[4 + i];
        block->axis_z[i] = camera->matrix[8 + i];
    }
    const float width = camera->window[1] - camera->window[0], height = camera->window[3] - camera->window[2];
    float offset[2];
    pixel_sample(sample, settings->samples, settings->filter_width, offset);
    block->window[0] = camera->window[0] + offset[0] * width / (float)settings->width;
    block->window[1] = camera->window[2] + offset[1] * height / (float)settings->height;
    block->window[2] = width;
    block->window[3] = height;
    block->image[0] = (float)settings->width;
    block->image[1] = (float)settings->height;
    block->image[2] = (float)settings->crop[0];
    block->image[3] = (float)settings->crop[1];
}

void camera_position(const struct camera_block *block, const float coordinate[2], float depth, vec3 position) {
    const float scale = block->perspective != 0.0f ? depth : 1.0f;
    float p[2];
    for (int i = 0; i < 2; i++)
        p[i] = scale * (block->window[i] + coordinate[i] / block->image[i] * block->window[2 + i]);
    for (int i = 0; i < 3; i++)
        position[i] = p[0] * block->axis_x[i] + p[1] * block->axis_y[i] - depth * block->axis_z[i];
}

void camera_projection(const struct camera_block *block, float near_depth, float far_depth, mat4 projection) {
    const float left = block->window[0], right = left + block->window[2];
    const float bottom = block->window[1], top = bottom + block->window[3];
    mat4 clip, view;
    if (block->perspective != 0.0f)
        glm_frustum(left * near_depth, right * near_depth, bottom * near_depth, top * near_depth, near_depth,
                    far_depth, clip);
    else
        glm_ortho(left, right, bottom, top, near_depth, far_depth, clip);
    glm_mat4_identity(view);
    for (int column = 0; column < 3; column++) {
        view[column][0] = block->axis_x[column];
        view[column][1] = block->axis_y[column];
        view[column][2] = block->axis_z[column];
    }
    glm_mat4_mul(clip, view, projection);
}
