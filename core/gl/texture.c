/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "texture.h"

int gl_format_bytes(GLenum format) {
    switch (format) {
    case GL_RGBA32F:
        return 16;
    case GL_RGBA16F:
    case GL_RGBA16_SNORM:
    case GL_RG32F:
    case GL_RG32UI:
        return 8;
    default: /* GL_R32F, GL_R32UI, GL_DEPTH_COMPONENT32F, GL_RG16F */
        return 4;
    }
}

uint64_t gl_texture_bytes(const struct gl_texture *texture) {
    uint64_t texels = 0;
    for (int level = 0; level < texture->levels; level++) {
        const int width = texture->width >> level, height = texture->height >> level;
        texels += (uint64_t)(width > 0 ? width : 1) * (uint64_t)(height > 0 ? height : 1);
    }
    return texels * (uint64_t)(texture->layers > 0 ? texture->layers : 1) * (uint64_t)gl_format_bytes(texture->format);
}

static GLenum texture_target(const struct gl_texture *texture) {
    return texture->layers > 0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D;
}

void gl_texture_free(const struct gl *gl, struct gl_texture *texture) {
    if (texture->id)
        gl->DeleteTextures(1, &texture->id);
    *texture = (struct gl_texture){0};
}

pnb_result gl_texture_ensure(const struct gl *gl, struct gl_texture *texture, GLenum format, int width, int height,
                             int layers, int levels) {
    if (texture->id && texture->format == format && texture->width == width && texture->height == height &&
        texture->layers == layers && texture->levels == levels)
        return PNB_OK;
    gl_texture_free(gl, texture);
    *texture = (struct gl_texture){0, format, width, height, layers, levels};
    gl->GenTextures(1, &texture->id);
    const GLenum target = texture_target(texture);
    gl->BindTexture(target, texture->id);
    if (layers > 0)
        gl->TexStorage3D(target, levels, format, width, height, layers);
    else
        gl->TexStorage2D(target, levels, format, width, height);
    gl->TexParameteri(target, GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
    gl->TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TexParameteri(target, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    pnb_result result = gl_check(gl, "texture storage");
    if (result != PNB_OK) {
        const uint64_t bytes = gl_texture_bytes(texture);
        gl_texture_free(gl, texture);
        if (result == PNB_ERROR_OUT_OF_MEMORY)
            return error_set(result, "out of OpenGL memory: a %d x %d x %d texture of %.0f MiB", width, height,
                             layers > 0 ? layers : 1, (double)bytes / 1048576.0);
    }
    return result;
}

void gl_texture_swap(struct gl_texture *a, struct gl_texture *b) {
    const struct gl_texture kept = *a;
    *a = *b;
    *b = kept;
}

void gl_texture_set_linear(const struct gl *gl, const struct gl_texture *texture) {
    const GLenum target = texture_target(texture);
    gl->BindTexture(target, texture->id);
    gl->TexParameteri(target, GL_TEXTURE_MIN_FILTER, texture->levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_LINEAR);
    gl->TexParameteri(target, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

void gl_texture_make_levels(const struct gl *gl, const struct gl_texture *texture) {
    gl->BindTexture(texture_target(texture), texture->id);
    gl->GenerateMipmap(texture_target(texture));
}

void gl_texture_bind(const struct gl *gl, const struct gl_texture *texture, int unit) {
    gl->ActiveTexture(GL_TEXTURE0 + (GLenum)unit);
    gl->BindTexture(texture_target(texture), texture->id);
}

static void attach(const struct gl *gl, GLenum point, const struct gl_texture *texture, int layer) {
    if (texture && texture->layers > 0)
        gl->FramebufferTextureLayer(GL_FRAMEBUFFER, point, texture->id, 0, layer);
    else
        gl->FramebufferTexture(GL_FRAMEBUFFER, point, texture ? texture->id : 0, 0);
}

pnb_result gl_target_bind(const struct gl *gl, GLuint fbo, const struct gl_target *target) {
    gl->BindFramebuffer(GL_FRAMEBUFFER, fbo);
    GLenum buffers[MAX_ATTACHMENTS];
    for (int i = 0; i < MAX_ATTACHMENTS; i++) {
        const bool used = i < target->color_count && target->colors[i];
        attach(gl, GL_COLOR_ATTACHMENT0 + (GLenum)i, used ? target->colors[i] : NULL, target->layer);
        buffers[i] = used ? GL_COLOR_ATTACHMENT0 + (GLenum)i : GL_NONE;
    }
    attach(gl, GL_DEPTH_ATTACHMENT, target->depth, target->layer);
    gl->DrawBuffers(MAX_ATTACHMENTS, buffers);
    const struct gl_texture *first = target->color_count > 0 ? target->colors[0] : target->depth;
    gl->Viewport(0, 0, first->width, first->height);
    const GLenum status = gl->CheckFramebufferStatus(GL_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        return error_set(status == GL_FRAMEBUFFER_UNSUPPORTED ? PNB_ERROR_UNSUPPORTED : PNB_ERROR_OUT_OF_MEMORY,
                         "a framebuffer of %d x %d is incomplete (0x%x)", first->width, first->height, status);
    return PNB_OK;
}
