/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pixels that are left to be drawn one by one: their number and as many pixels, in no order. A pass over the image
 * works on vectors of neighbours, in llvmpipe as in GPUs; of few pixels here and there it would throw away most of
 * each. */
#include "passes.h"

#define CAPACITY (1 << 20) /* more than the pixels of a row of any image */
#define GROUP    64        /* pass_visibility_list.comp: local_size_x */

int pixel_list_rows(const struct frame *frame) {
    return CAPACITY / frame->width;
}

pnb_result pixel_list_begin(struct frame *frame) {
    struct gl_buffer *list = &frame->renderer->pixel_list;
    const uint64_t bytes = (1 + (uint64_t)frame->width * (uint64_t)pixel_list_rows(frame)) * sizeof(uint32_t);
    pnb_result result = gl_buffer_ensure(frame->gl, list, bytes, 0, "list of pixels");
    if (result != PNB_OK)
        return result;
    gl_buffer_clear(frame->gl, list, sizeof(uint32_t));
    gl_buffer_bind(frame->gl, list, 1);
    return PNB_OK;
}

void pixel_list_dispatch(struct frame *frame) {
    const struct gl *gl = frame->gl;
    const uint32_t row = 1024; /* of groups: OpenGL allows 65535 at least */
    uint32_t count = 0;
    gl->MemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                      GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    gl_buffer_bind(gl, &frame->renderer->pixel_list, 1);
    gl->GetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, sizeof count, &count);
    const uint32_t groups = (count + GROUP - 1) / GROUP;
    if (groups > 0)
        gl->DispatchCompute(groups < row ? groups : row, (groups + row - 1) / row, 1);
    gl->MemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);
}
