/* SPDX-License-Identifier: GPL-3.0-or-later
 * The shared passes. Each names what it reads and what it writes (texture, size, space, format). All run on the
 * OpenGL thread, record their own timing, and leave the framebuffer, program and textures they bound bound: a pass
 * sets all the state it depends on. W x H is the crop's size, S the shadow map's side. */
#ifndef PNB_PASSES_H
#define PNB_PASSES_H

#include "../gl/program.h"
#include "../render/frame.h"
#include "../render/gpu_scene.h"
#include "../render/kept.h"
#include "../render/timer.h"
#include "../techniques/technique.h"

/* One light as common_light.glsl reads it (std140). */
struct light_block {
    struct light_view views[MAX_LIGHT_VIEWS];
    vec4 position, frame_x, frame_y, frame_z, half_u, half_v, emission,
        cone; /* cone.x of an AREA: see common_light.glsl */
    int32_t faces_a[4], faces_b[4];
    float tan_half_angle, casts_shadow;
    int32_t view_count;
    float padding;
};
_Static_assert(sizeof(struct light_view) == 96, "std140 layout of light_view");
_Static_assert(sizeof(struct light_block) == 6 * 96 + 11 * 16, "std140 layout of light_block");
_Static_assert(sizeof(struct camera_block) == 7 * 16, "std140 layout of camera_block");

struct renderer {
    const struct gl *gl;
    struct gpu_scene *scene;
    struct timer timer;
    GLuint framebuffer, empty_vertex_array, camera_buffer, light_buffer, tap_buffer;
    GLuint range_buffer, tile_buffer, tile_visibility_buffer, tile_vertex_array;
    GLuint cursor_buffer; /* one number: the end of the fragments, fragment_lists.c */
    struct program_cache programs;
    struct kept kept;

    /* G-buffer, of the full image's size: see common_camera.glsl for the contents. */
    struct gl_texture gbuffer_depth, gbuffer_normal, gbuffer_color, gbuffer_z;
    struct gl_texture gbuffer_emission; /* exists only while something emits */
    struct gl_texture gbuffer_links; /* RG32UI: bits of the lights that do not light a pixel; only with light linking */
    struct gl_texture key_depth, key_normal; /* the G-buffer's of the key sample, reuse.c */
    struct gl_texture
        visibility; /* RGBA16F or RGBA32F, W x H: rgb = visibility times weight, a = weight, of one light */
    struct gl_texture coarse_visibility; /* with SUBSAMPLING_PARAMETER: of every other pixel, RGBA16F or R32F */
    struct gl_buffer pixel_list;         /* pixels where it cannot be interpolated, pixel_list.c */
    /* Of the sample being drawn, W x H: sums over the lights, RGBA32F, with and without shadows; and what is drawn
     * anew, DEPTH_COMPONENT32F, see reuse.c. The last two exist if they are wanted. */
    struct gl_texture irradiance, unshadowed_irradiance, drawn;
    /* Sums over the samples, RGBA32F, W x H. */
    struct gl_texture combined, shadowed, unshadowed, normal;
    /* Of the shadow catchers alone, if there are any: irradiance with the ambient light's; caught.a = coverage. */
    struct gl_texture caught, uncaught;
    struct gl_texture light_shadows[MAX_LIGHTS];
};

/* pass.c: waits for what is queued, which would run before whatever comes next; CANCELLED if the job was. */
pnb_result check_cancel(struct frame *frame);
/* Begins and ends the timing of a pass. A cancel of a job that somebody watches is noticed before every pass. bytes: of
 * the textures and buffers the pass owns. */
pnb_result pass_begin(struct frame *frame, const char *name);
void pass_end(struct frame *frame, uint64_t bytes);
/* gbuffer.c: uploads the frame's camera for the shaders of the passes after it. */
void camera_block_upload(struct frame *frame);
/* Scene -> gbuffer_* of the frame's sample; whole: all of the full image, else only the crop. */
pnb_result pass_gbuffer(struct frame *frame, bool whole);
/* tiles.c: G-buffer -> range_buffer, tile_buffer: depths and bounds of what each tile of the full image shows. */
pnb_result pass_tiles(struct frame *frame);
/* range_buffer -> frame->receivers. */
pnb_result read_receivers(struct frame *frame);
/* Tiles, min_max, planes -> tile_visibility_buffer: 0, 1 or undecided, for a technique with `technique_extent`. */
pnb_result pass_classify(struct frame *frame, const struct frame_light *light);
/* What a pass over the image is drawn as: one triangle; tiles with their visibility; tiles that are all undecided. */
enum tiles { TILES_NONE, TILES_CLASSIFIED, TILES_UNDECIDED };
/* Draws over the bound target with the current program, or only where tiles are undecided. */
void draw_over(struct frame *frame, GLuint program, enum tiles tiles, bool undecided_only);
/* shadow_map.c: casters -> map, DEPTH_COMPONENT32F, S x S x a layer per view, linear light-space depth 0..1. What of
 * translucent casters a map keeps: those that hide half of the light or more, or, where samples are averaged, as large
 * a share of their texels as of the light they hide, others in each sample; nothing but what is opaque; everything. */
enum translucency { TRANSLUCENCY_CUT, TRANSLUCENCY_STOCHASTIC, TRANSLUCENCY_OPAQUE, TRANSLUCENCY_ANY };
pnb_result pass_shadow_map(struct frame *frame, const struct light_views *views, int side,
                           enum translucency translucency, struct gl_texture *map);
/* fragment_lists.c: casters -> lists, sorted by depth. Draws at the size of `map`, which it leaves as it is. what: for
 * messages, names the light. */
struct fragment_choice {
    enum casters casters; /* all that cast shadows, or what is neither opaque nor clear */
    bool back_faces;      /* without the front faces of solid bodies */
    float joined;         /* depths so close become one, in texels; 0: none */
    int accumulation;     /* of what is joined, as in struct fragment_filter */
    uint32_t most;        /* of each list the nearest so many are kept, 0: all */
};
pnb_result pass_fragment_lists(struct frame *frame, const struct light_views *views,
                               const struct fragment_choice *choice, const struct gl_texture *map, const char *what,
                               struct fragment_lists *lists);
/* The define that tells shaders how opacity is accumulated. */
const char *accumulation_define(int accumulation);
/* Gives the current program the lists, which fragment_lists_forget must follow when the job ends. */
void fragment_lists_bind(struct frame *frame, GLuint program, const struct fragment_lists *lists);
void fragment_lists_free(const struct gl *gl, struct fragment_lists *lists);
/* After a job that has bound lists: makes the driver let go of them, once they are freed. */
pnb_result fragment_lists_forget(struct frame *frame);
/* fragment_filter.c: lists of a map of so many texels per side -> further levels of them. */
struct fragment_filter {
    int level_count;       /* at most, with the lists themselves */
    int stack_side;        /* a level of no more texels per side is followed by a stack; 0: never */
    int subsampled_levels; /* the first so many leave out texels instead of merging them */
    int accumulation; /* of what is merged behind one another: 0 adds opacities, 1 multiplies, 2 takes the greatest */
    float merge_distance; /* depths so close become one, in widths of a level's texel in the MIP map */
    float light_size;     /* side of the emitter, metres; SUN: its extent at distance 1 */
};
pnb_result pass_fragment_filter(struct frame *frame, const struct light_views *views,
                                const struct fragment_filter *filter, int side, const char *what,
                                struct fragment_lists *lists);
/* The levels there will be; gives their number. */
uint32_t fragment_levels(struct fragment_level levels[MAX_FRAGMENT_LEVELS], const struct fragment_filter *filter,
                         int side, int layers);
/* Bytes of one fragment. */
uint64_t fragment_size(const struct scene *scene);
/* What every shader that includes common_fragments.glsl needs: whether opacity has a colour, and fragments several
 * blocks. NULL: nothing. */
const char *fragment_defines(const struct frame *frame, const struct fragment_lists *lists);
/* min_max.c: map -> pyramid, RG32F, S/2 x S/2 x layers with all levels: least and greatest depth. */
pnb_result pass_min_max(struct frame *frame, const struct gl_texture *map, struct gl_texture *pyramid);
/* gauss.c: texture, any float format with a layer per view -> the same, convolved with a Gaussian of 3, 5 or 7 texels
 * (binomial weights), level 0 only. Beyond the border lie copies of its last row and column. */
pnb_result pass_gauss(struct frame *frame, struct gl_texture *texture, int width);
/* Summed-area tables: at each texel the sum of what lies left of, below and at it within its tile. */
struct summed_area {
    int channels;       /* 1 or 2 */
    int tile;           /* texels along the side of a tile, a power of two; from the table's side on: one tile */
    bool floats;        /* float32 sums, whose error grows with the table, instead of integers */
    float scale;        /* integers: sums of round(value * scale), which wrap around. A rectangle's sum is exact while
                         * the rectangle's own sum is below 2^32 */
    const char *values; /* shader file with `vec4 summed_value(ivec3 texel)`: the values, of x and y, 0..1 */
    /* Binds what that file reads; image unit 0 is taken. */
    void (*bind)(struct frame *frame, GLuint program, const void *user);
    const void *user;
};
/* Makes room for a table and its levels, of half the side each, all in level 0 of the texture: table_origin in
 * common_summed_area.glsl. side: of the table itself. */
pnb_result summed_area_ensure(const struct gl *gl, struct gl_texture *table, int channels, int side, int layers,
                              int levels);
/* summed_area.c: values -> one level of table, a layer per view. */
pnb_result pass_summed_area(struct frame *frame, const struct summed_area *sums, const struct gl_texture *table,
                            int level);
/* planes.c: light->shadow_map -> light->planes, RGBA32F, a texel per 4 x 4 texels with all levels: see
 * common_planes.glsl. Needs the light's block. */
pnb_result pass_planes(struct frame *frame, struct frame_light *light);
/* visibility.c: G-buffer, map, min_max -> renderer.visibility, by the technique; tiles: of undecided ones only. */
pnb_result pass_visibility(struct frame *frame, const struct frame_light *light, enum tiles tiles);
/* subsampling.c: makes coarse_visibility, or frees it if it is not wanted. */
pnb_result ensure_subsampling(struct frame *frame, bool wanted);
/* Gives the current program what says which pixel a texel of coarse_visibility is. */
void bind_subsampling(struct frame *frame, GLuint program);
/* G-buffer, coarse_visibility -> visibility, where it can be interpolated, and pixel_list, where it cannot, of so many
 * rows of the crop, at most pixel_list_rows. */
pnb_result pass_interpolate(struct frame *frame, const struct frame_light *light, int row, int rows);
/* pixel_list.c: empties pixel_list and binds it for shaders that add to it. */
pnb_result pixel_list_begin(struct frame *frame);
/* Rows of the crop for whose pixels there is room. */
int pixel_list_rows(const struct frame *frame);
/* Runs the current program, a compute shader, for every pixel of the list. */
void pixel_list_dispatch(struct frame *frame);
/* irradiance.c: makes the sample's sums over the lights; adds to them one light's irradiance times visibility, that of
 * the tile where it is decided, and to the light's share of the shadow pass. first: replaces what the sums held. */
pnb_result ensure_irradiance(struct frame *frame);
pnb_result pass_irradiance(struct frame *frame, const struct frame_light *light, bool first, enum tiles tiles);
/* Sets the depth test by which a light's passes draw only the pixels that are not reused. */
void test_drawn(struct frame *frame);
/* The same test for any texture with 1 where passes draw, or none. */
void test_depth(struct frame *frame, bool on);
/* reuse.c: how many samples are lit at every pixel, and whether this one is. */
uint32_t reuse_key_count(const struct frame *frame);
bool reuse_is_key(const struct frame *frame);
/* Gives the current program what common_steady.glsl reads. */
void bind_steady(struct frame *frame, GLuint program);
/* Sets camera.lit of a key sample: the mean of the samples it stands for. */
void reuse_light_mean(struct frame *frame);
/* Keeps the key's G-buffer, before the next sample's is drawn. */
void reuse_keep_key(struct frame *frame);
/* Every pixel is drawn, or none. */
pnb_result reuse_set_drawn(struct frame *frame, bool drawn);
/* G-buffer, key -> drawn: pixels that see something else than the key. */
pnb_result pass_reuse(struct frame *frame);
/* Uploads the light for the shaders of the passes after it. */
void light_block_upload(struct renderer *renderer, const struct emitter *emitter, const struct light_views *views);
/* #define lines for the shaders of a pass over one light: its type, outline and number of views as constants, since a
 * software renderer executes both sides of every branch. Static string. */
const char *light_defines(const struct emitter *emitter, const struct light_views *views);
/* What the technique's row defines for its shader; NULL: nothing. */
const char *technique_defines(const struct frame_light *light);
/* Gives the current program the light's maps and the technique's parameters, taps and own textures. */
void bind_technique(struct frame *frame, const struct frame_light *light, GLuint program);
/* Sets the technique's parameters as uniforms `p_<name>` of the current program. */
void set_parameters(const struct gl *gl, GLuint program, const struct frame_light *light);
/* Binds gbuffer_depth, _normal and _color as the current program's samplers. */
void bind_gbuffer(struct renderer *renderer, GLuint program);
/* The texture, or NULL if it was not made. */
const struct gl_texture *if_made(const struct gl_texture *texture);
/* shading.c: makes the sums; adds to them what the sample's surfaces reflect of its irradiance, and with the first
 * group of lights what needs no light: background, ambient light, emission and normal. */
pnb_result pass_prepare_sums(struct frame *frame);
pnb_result pass_shading(struct frame *frame, bool first);
/* diagnosis.c: whether passes to look at how shadows come about are wanted; those that search for blockers. */
bool wants_diagnosis(const struct frame *frame);
bool wants_blockers(const struct frame *frame);
/* G-buffer, shadow_map, min_max -> the job's images of one light. */
pnb_result pass_diagnosis(struct frame *frame, const struct frame_light *light);
/* resolve.c: makes the job's images; fills what is wanted of the first sample alone (depth); sums -> images. */
pnb_result pass_create_images(struct frame *frame);
pnb_result pass_resolve_first_sample(struct frame *frame);
pnb_result pass_resolve(struct frame *frame);

/* Draws one triangle over the bound target with the current program. */
void draw_screen(struct renderer *renderer);

#endif
