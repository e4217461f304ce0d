/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "memory.h"
#include "scene/content_key.h"
#include "scene/texture.h"

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static pnb_texture_desc describe(uint32_t width, uint32_t height, uint32_t channels, const float *pixels) {
    return (pnb_texture_desc){.struct_size = sizeof(pnb_texture_desc),
                              .width = width,
                              .height = height,
                              .channels = channels,
                              .name = "Image",
                              .pixels = {pixels, 0}};
}

static pnb_texture *create(const pnb_texture_desc *desc) {
    pnb_texture *texture = NULL;
    assert_int_equal(pnb_texture_create(desc, &texture), PNB_OK);
    assert_non_null(texture);
    return texture;
}

static void assert_texel(const pnb_texture *texture, size_t index, float r, float g, float b, float a) {
    const float *texel = texture->rgba + 4 * index;
    assert_true(texel[0] == r && texel[1] == g && texel[2] == b && texel[3] == a);
}

static void channels_become_rgba(void **state) {
    (void)state;
    static const float pixels[8] = {0.125f, 0.25f, 0.5f, 0.75f, 1, 2, 3, 0.0625f};
    static const struct {
        uint32_t channels;
        bool has_alpha;
        float second[4]; /* the second texel */
    } cases[] = {{1, false, {0.25f, 0.25f, 0.25f, 1}},
                 {2, true, {0.5f, 0.5f, 0.5f, 0.75f}},
                 {3, false, {0.75f, 1, 2, 1}},
                 {4, true, {1, 2, 3, 0.0625f}}};
    for (size_t i = 0; i < 4; i++) {
        pnb_texture_desc desc = describe(2, 1, cases[i].channels, pixels);
        pnb_texture *texture = create(&desc);
        const float *second = cases[i].second;
        assert_texel(texture, 1, second[0], second[1], second[2], second[3]);
        assert_int_equal(texture->has_alpha, cases[i].has_alpha);
        pnb_texture_destroy(&texture);
    }
}

/* The decoding curve in double precision; single precision is about 1e-7 away from it, relatively. */
static double srgb_decoded(double value) {
    return value <= 0.04045 ? value / 12.92 : pow((value + 0.055) / 1.055, 2.4);
}

static void srgb_colors_are_decoded(void **state) {
    (void)state;
    enum { COUNT = 3000 };
    static float pixels[COUNT][2];
    for (int i = 0; i < COUNT; i++) { /* all values of 8 bits, then others up to 2.7 */
        pixels[i][0] = i < 256 ? (float)i / 255 : (float)i / 1111;
        pixels[i][1] = (float)i / COUNT;
    }
    pnb_texture_desc desc = describe(COUNT, 1, 2, &pixels[0][0]);
    desc.is_srgb = 1;
    pnb_texture *texture = create(&desc);
    for (int i = 0; i < COUNT; i++) {
        double expected = srgb_decoded((double)pixels[i][0]), actual = (double)texture->rgba[4 * i];
        assert_true(fabs(actual - expected) <= 1e-6 * expected);
        assert_true(texture->rgba[4 * i + 1] == texture->rgba[4 * i]);
        assert_true(texture->rgba[4 * i + 3] == pixels[i][1]); /* alpha is linear */
    }
    pnb_texture_destroy(&texture);
}

static void bad_values_are_clamped(void **state) {
    (void)state;
    static const float pixels[7][4] = {{NAN, 1, 1, NAN},   {INFINITY, -INFINITY, 1, INFINITY},
                                       {-1, -0.5f, 0, -1}, {65504, 65505, FLT_MAX, 2},
                                       {1e-45f, 1, 1, 0},  {1, 1, 1, 0.5f},
                                       {1e30f, 1, 1, 1}};
    for (uint32_t srgb = 0; srgb < 2; srgb++) {
        pnb_texture_desc desc = describe(7, 1, 4, &pixels[0][0]);
        desc.is_srgb = srgb;
        pnb_texture *texture = create(&desc);
        assert_texel(texture, 0, 0, 1, 1, 0);
        assert_texel(texture, 1, 0, 0, 1, 0);
        assert_texel(texture, 2, 0, 0, 0, 0);
        assert_texel(texture, 3, 65504, 65504, 65504, 1);
        assert_texel(texture, 5, 1, 1, 1, 0.5f);
        assert_texel(texture, 6, 65504, 1, 1, 1);
        pnb_texture_destroy(&texture);
    }
}

static void strides_and_alignment_do_not_matter(void **state) {
    (void)state;
    static const float pixels[6][3] = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}, {10, 11, 12}, {13, 14, 15}, {16, 17, 18}};
    unsigned char spread[6 * 23 + 1];
    for (size_t i = 0; i < 6; i++) {
        memcpy(spread + 1 + 23 * i, pixels[i], sizeof pixels[i]);
    }
    pnb_texture_desc desc = describe(3, 2, 3, &pixels[0][0]);
    pnb_texture *packed = create(&desc);
    desc.pixels = (pnb_array){spread + 1, 23};
    pnb_texture *strided = create(&desc);
    assert_memory_equal(packed->rgba, strided->rgba, 6 * 16);
    assert_true(content_key_equal(&packed->content, &strided->content));
    pnb_texture_destroy(&packed);
    pnb_texture_destroy(&strided);
}

static void content_follows_the_data(void **state) {
    (void)state;
    static float pixels[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    pnb_texture_desc desc = describe(2, 4, 1, pixels);
    pnb_texture *tall = create(&desc);
    desc = describe(4, 2, 1, pixels);
    pnb_texture *wide = create(&desc);
    desc.name = "Another name";
    pnb_texture *same = create(&desc);
    desc = describe(2, 2, 2, pixels);
    pnb_texture *alpha = create(&desc);
    desc = describe(2, 2, 1, pixels);
    pnb_texture *grey = create(&desc);
    assert_false(content_key_equal(&tall->content, &wide->content));
    assert_true(content_key_equal(&wide->content, &same->content));
    assert_false(content_key_equal(&alpha->content, &grey->content)); /* same texels, another meaning */
    pnb_texture_destroy(&tall);
    pnb_texture_destroy(&wide);
    pnb_texture_destroy(&same);
    pnb_texture_destroy(&alpha);
    pnb_texture_destroy(&grey);
}

static void broken_descriptions_are_errors(void **state) {
    (void)state;
    static const float pixels[4] = {0};
    pnb_texture *texture = NULL;
    pnb_texture_desc desc = describe(1, 1, 4, pixels);
    assert_int_equal(pnb_texture_create(NULL, &texture), PNB_ERROR_INVALID_ARGUMENT);
    assert_int_equal(pnb_texture_create(&desc, NULL), PNB_ERROR_INVALID_ARGUMENT);
    desc.struct_size = 0;
    assert_int_equal(pnb_texture_create(&desc, &texture), PNB_ERROR_INVALID_ARGUMENT);
    static const uint32_t sizes[][3] = {{0, 1, 4}, {1, 0, 4}, {16385, 1, 4}, {1, 16385, 4}, {UINT32_MAX, UINT32_MAX, 4},
                                        {1, 1, 0}, {1, 1, 5}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        desc = describe(sizes[i][0], sizes[i][1], sizes[i][2], pixels);
        assert_int_equal(pnb_texture_create(&desc, &texture), PNB_ERROR_INVALID_ARGUMENT);
        assert_non_null(strstr(pnb_last_error(), "texture 'Image'"));
    }
    desc = describe(1, 1, 4, NULL);
    assert_int_equal(pnb_texture_create(&desc, &texture), PNB_ERROR_INVALID_ARGUMENT);
    assert_null(texture);
    pnb_texture_destroy(&texture);
    pnb_texture_destroy(NULL);
}

static void widest_textures_work(void **state) {
    (void)state;
    float *pixels = calloc(TEXTURE_MAX_SIDE, sizeof *pixels);
    assert_non_null(pixels);
    pixels[TEXTURE_MAX_SIDE - 1] = 0.5f;
    pnb_texture_desc desc = describe(TEXTURE_MAX_SIDE, 1, 1, pixels);
    pnb_texture *texture = create(&desc);
    assert_texel(texture, TEXTURE_MAX_SIDE - 1, 0.5f, 0.5f, 0.5f, 1);
    pnb_texture_destroy(&texture);
    free(pixels);
}

static void every_allocation_may_fail(void **state) {
    (void)state;
    static const float pixels[4] = {0};
    pnb_texture_desc desc = describe(2, 2, 1, pixels);
    int64_t before = memory_live_blocks();
    uint64_t failures = 0;
    for (;;) {
        pnb_texture *texture = NULL;
        memory_fail_at(failures + 1);
        pnb_result result = pnb_texture_create(&desc, &texture);
        memory_fail_at(0);
        if (result == PNB_OK) {
            pnb_texture *second = texture_retain(texture);
            pnb_texture_destroy(&texture);
            assert_string_equal(second->name, "Image");
            pnb_texture_destroy(&second);
            break;
        }
        assert_int_equal(result, PNB_ERROR_OUT_OF_MEMORY);
        assert_null(texture);
        assert_int_equal(memory_live_blocks(), before);
        failures++;
    }
    assert_int_equal(failures, 3);
    assert_int_equal(memory_live_blocks(), before);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_become_rgba),     cmocka_unit_test(srgb_colors_are_decoded),
        cmocka_unit_test(bad_values_are_clamped),   cmocka_unit_test(strides_and_alignment_do_not_matter),
        cmocka_unit_test(content_follows_the_data), cmocka_unit_test(broken_descriptions_are_errors),
        cmocka_unit_test(widest_textures_work),     cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
