// SPDX-License-Identifier: GPL-3.0-or-later
#include "glm_oracle.h"

#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

static void store(const glm::dmat4 &matrix, double to[16]) {
    std::memcpy(to, glm::value_ptr(matrix), sizeof matrix);
}

static glm::dmat4 projection(double left, double right, double bottom, double top, double near_depth, double far_depth,
                             bool perspective) {
    return perspective ? glm::frustum(left * near_depth, right * near_depth, bottom * near_depth, top * near_depth,
                                      near_depth, far_depth)
                       : glm::ortho(left, right, bottom, top, near_depth, far_depth);
}

void glm_camera(const float camera[16], const float window[4], int perspective, float near_depth, float far_depth,
                double clip[16]) {
    glm::dmat4 world(glm::make_mat4(camera));
    world[3] = glm::dvec4(0, 0, 0, 1);
    store(projection(window[0], window[1], window[2], window[3], near_depth, far_depth, perspective != 0) *
              glm::inverse(world),
          clip);
}

void glm_light_space(const float eye[3], const float forward[3], const float up[3], double matrix[16]) {
    const glm::dvec3 from(glm::make_vec3(eye)), along(glm::make_vec3(forward)), upwards(glm::make_vec3(up));
    store(glm::lookAtLH(from, from + along, upwards), matrix);
}

void glm_light_projection(const float rect[4], float near_depth, float far_depth, int perspective, double matrix[16]) {
    // GLM's right-handed projections look along -Z. (Its frustumLH has the wrong sign off the axis, up to 0.9.9.8.)
    const glm::dmat4 flip = glm::scale(glm::dmat4(1), glm::dvec3(1, 1, -1));
    store(projection(rect[0], rect[0] + 1.0 / rect[2], rect[1], rect[1] + 1.0 / rect[3], near_depth, far_depth,
                     perspective != 0) *
              flip,
          matrix);
}
