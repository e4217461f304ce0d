/* SPDX-License-Identifier: GPL-3.0-or-later
 * Matrices built with GLM: the oracle for those the library builds. Column-major, 16 floats. */
#ifndef GLM_ORACLE_H
#define GLM_ORACLE_H

#ifdef __cplusplus
extern "C" {
#endif

/* World relative to the camera to clip space. camera: object to world. window: left, right, bottom, top, at distance 1
 * or, orthographic, in metres. */
void glm_camera(const float camera[16], const float window[4], int perspective, float near_depth, float far_depth,
                double clip[16]);

/* Relative world to the light space of a view (+Z forward): eye, and the directions to look along and upwards. */
void glm_light_space(const float eye[3], const float forward[3], const float up[3], double matrix[16]);

/* Light space to clip space. rect: lower left corner and 1 / extent of the map in q. */
void glm_light_projection(const float rect[4], float near_depth, float far_depth, int perspective, double matrix[16]);

#ifdef __cplusplus
}
#endif

#endif
