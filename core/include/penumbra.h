/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * Penumbra: soft shadow mapping techniques on OpenGL, off screen, with or without a GPU.
 *
 *   pnb_mesh, pnb_texture   immutable copies of host data, shared by any number of scenes
 *   pnb_scene               a plain description of one frame: instances, materials, lights, camera
 *   pnb_context             owns one OpenGL context and the one thread that ever uses it
 *   pnb_job                 one render: start, wait or poll, cancel, read its images
 *
 * Conventions, unless a declaration says otherwise:
 *  - Units are metres, radians and watts. World space is right-handed with Z up. Matrices are 4 x 4 floats in
 *    column-major order (translation in elements 12..14), object to world. Whatever reaches farther than 1e9 m from
 *    the world's origin is dropped with a warning.
 *  - Every structure starts with `struct_size`, to be set to sizeof the structure (PNB_INIT does it). All other
 *    members zero mean the documented defaults. A size the library does not know is PNB_ERROR_INVALID_ARGUMENT.
 *  - Descriptions are copied during the call; the library keeps no pointer into host memory.
 *  - A destroy function takes the address of the handle, sets it to NULL, and accepts NULL and a NULL handle.
 *  - Functions return PNB_OK or an error; pnb_last_error() then holds the reason, naming the object at fault.
 *    Out parameters are written only on success.
 *  - Thread-safety: every function may be called from any thread at any time, except that a handle must not be
 *    destroyed while another call is using it. No OpenGL or EGL context of the calling thread is ever touched.
 *  - After fork() the child may only use functions that need no context; the others return PNB_ERROR_FORKED.
 *  - The library never prints, exits or aborts. */
#ifndef PENUMBRA_H
#define PENUMBRA_H

#include <stddef.h>
#include <stdint.h>

#define PNB_VERSION "0.1.0"
/* Raised by every change of this header that is not a pure addition. */
#define PNB_API_VERSION 6u

#ifdef PNB_BUILD
#define PNB_API __attribute__((visibility("default")))
#else
#define PNB_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* Initialiser of any structure below: `pnb_settings settings = PNB_INIT(pnb_settings);` */
#ifdef __cplusplus
#define PNB_INIT(type) type{sizeof(type)}
#else
#define PNB_INIT(type) {.struct_size = sizeof(type)}
#endif

/* ---- Versions, results, messages -------------------------------------------------------------------------- */

typedef enum pnb_result {
    PNB_OK = 0,
    PNB_TIMEOUT = 1,                 /* pnb_job_wait: still rendering; not an error */
    PNB_ERROR_INVALID_ARGUMENT = -1, /* NULL, wrong struct_size, out of range, unknown name */
    PNB_ERROR_NO_BACKEND = -2,       /* no OpenGL could be opened; the message lists every attempt */
    PNB_ERROR_UNSUPPORTED = -3,      /* OpenGL too old, or a size beyond its limits */
    PNB_ERROR_OUT_OF_MEMORY = -4,    /* host or OpenGL memory */
    PNB_ERROR_CANCELLED = -5,        /* the job was cancelled */
    PNB_ERROR_CONTEXT_LOST = -6,     /* the OpenGL context died; create a new one */
    PNB_ERROR_FORKED = -7,           /* called in a child process that did not create the context */
    PNB_ERROR_FILE = -8,             /* a file could not be read or written, or is damaged */
    PNB_ERROR_INTERNAL = -9          /* a defect of the library, such as a shader that does not compile */
} pnb_result;

/* PNB_API_VERSION the library was built with; compare it before any other call when loading dynamically. */
PNB_API uint32_t pnb_api_version(void);
/* PNB_VERSION of the library, a static string. */
PNB_API const char *pnb_version(void);
/* Constant name such as "PNB_ERROR_FILE"; "unknown" for other values. Static string. */
PNB_API const char *pnb_result_name(pnb_result result);
/* Why the last failing call of this thread failed; "" if none did. Valid until this thread's next library call. */
PNB_API const char *pnb_last_error(void);

typedef enum pnb_log_level {
    PNB_LOG_NONE = 0,
    PNB_LOG_ERROR = 1,   /* the call or the job fails */
    PNB_LOG_WARNING = 2, /* the result lacks or approximates something the host asked for */
    PNB_LOG_INFO = 3,    /* which backend was taken, what it costs */
    PNB_LOG_DEBUG = 4    /* OpenGL debug output */
} pnb_log_level;

/* Receives one message, UTF-8 without a newline, on any thread, at most one call at a time per context. */
typedef void (*pnb_log_function)(void *user, pnb_log_level level, const char *message);

/* ---- Context ---------------------------------------------------------------------------------------------- */

typedef struct pnb_context pnb_context;

typedef struct pnb_context_desc {
    uint32_t struct_size;
    pnb_log_level log_level; /* messages up to this level are logged; PNB_LOG_NONE: no logging */
    const char *backend;     /* "egl" (any device), "egl:N" (device N), "surfaceless", "osmesa"; NULL or "": the
                              * environment variable PENUMBRA_BACKEND, else each in that order until one works */
    pnb_log_function log;    /* NULL: no logging */
    void *log_user;          /* passed to log; must outlive the context */
} pnb_context_desc;

typedef struct pnb_context_info {
    uint32_t struct_size;
    uint32_t is_software;      /* 1: the renderer runs on the CPU */
    uint32_t gl_major, gl_minor;
    uint32_t max_texture_size; /* texels per side: the limit of image sides and shadow_map_size */
    uint32_t reserved;
    char backend[32];          /* "egl:0", "surfaceless", "osmesa" */
    char vendor[128], renderer[128], version[128], shading_language[128]; /* OpenGL strings, UTF-8, cut to fit */
} pnb_context_info;

/* Opens OpenGL 4.3 core or newer and starts its thread. desc NULL: all defaults. The caller owns *context.
 * Errors: NO_BACKEND, UNSUPPORTED, OUT_OF_MEMORY, INVALID_ARGUMENT (unknown backend name). */
PNB_API pnb_result pnb_context_create(const pnb_context_desc *desc, pnb_context **context);
/* Cancels and waits for the context's jobs, then closes OpenGL. Jobs stay readable until they are destroyed. In a
 * forked child: frees nothing and returns at once. */
PNB_API void pnb_context_destroy(pnb_context **context);
/* info->struct_size must be set. */
PNB_API pnb_result pnb_context_get_info(const pnb_context *context, pnb_context_info *info);

typedef struct pnb_backend_attempt {
    uint32_t struct_size;
    pnb_result result;
    char backend[32];
    char message[256];                /* why it failed, with the EGL error; "" if it works */
    char renderer[128], version[128]; /* OpenGL strings; "" if it failed */
} pnb_backend_attempt;

/* Tries every backend of the ladder by opening it and clearing and reading one pixel. Writes up to capacity
 * attempts (each struct_size must be set beforehand) and the number of backends tried to *count. */
PNB_API pnb_result pnb_probe_backends(pnb_backend_attempt *attempts, uint32_t capacity, uint32_t *count);

/* ---- Meshes and textures ---------------------------------------------------------------------------------- */

/* Elements `stride` bytes apart, starting at `data`; stride 0: tightly packed. data NULL: absent. */
typedef struct pnb_array {
    const void *data;
    uint64_t stride;
} pnb_array;

typedef struct pnb_mesh pnb_mesh;

/* A triangle mesh the way modelling programs keep it: triangles name corners, corners name vertices. */
typedef struct pnb_mesh_desc {
    uint32_t struct_size;
    uint32_t vertex_count;
    uint32_t corner_count;
    uint32_t triangle_count;
    uint32_t polygon_count;       /* elements of polygon_materials; 0: triangle_count */
    uint32_t reserved;
    const char *name;             /* for messages; NULL: "mesh" */
    pnb_array positions;          /* float[3] per vertex, metres in object space */
    pnb_array corner_vertices;    /* uint32 vertex of each corner; absent: corner i is vertex i */
    pnb_array corner_normals;     /* float[3] per corner, absent, zero or not finite: the triangle's own normal */
    pnb_array corner_uvs;         /* float[2] per corner; absent: zero */
    pnb_array triangles;          /* uint32[3] corners of each triangle, counter-clockwise seen from the front */
    pnb_array triangle_polygons;  /* uint32 polygon of each triangle; absent: polygon i is triangle i */
    pnb_array polygon_materials;  /* int32 material slot of each polygon, below 0 counts as 0; absent: slot 0 */
    pnb_array corner_colors;      /* float[3] per corner, linear, kept in 8 bits between 0 and 1; for materials with
                                   * PNB_MATERIAL_VERTEX_COLOR; absent: vertex_colors */
    pnb_array vertex_colors;      /* float[3] per vertex; absent: white */
} pnb_mesh_desc;

/* Copies a mesh. Triangles that use non-finite positions or out-of-range indices are dropped, and zero-area ones
 * too; pnb_mesh_warning says how many. An empty mesh is valid. Meshes of equal content share OpenGL memory, so
 * creating one again for an unchanged object uploads nothing. The caller owns *mesh; jobs keep what they use. */
PNB_API pnb_result pnb_mesh_create(const pnb_mesh_desc *desc, pnb_mesh **mesh);
PNB_API void pnb_mesh_destroy(pnb_mesh **mesh);
/* Curves as thin tubes, such as hair, smooth through their points (Catmull-Rom): a mesh of prisms of five sides, three
 * where there are many points, as wide on average as a round tube, with its normals. Curve i has the points
 * first_points[i] .. first_points[i + 1] - 1. Its uv is that of the curve everywhere. */
typedef struct pnb_strands_desc {
    uint32_t struct_size;
    uint32_t point_count;
    uint32_t strand_count;
    uint32_t reserved;
    const char *name;       /* for messages; NULL: "strands" */
    pnb_array positions;    /* float[3] per point, metres in object space */
    pnb_array radii;        /* float per point, metres; absent: 0.005 */
    pnb_array first_points; /* uint32 per strand, ascending */
    pnb_array uvs;          /* float[2] per strand; absent: zero */
} pnb_strands_desc;

PNB_API pnb_result pnb_mesh_create_strands(const pnb_strands_desc *desc, pnb_mesh **mesh);

/* Points as little polyhedra of 80 triangles, of 20 where there are many, as large on average as round ones, with their
 * normals. */
typedef struct pnb_points_desc {
    uint32_t struct_size;
    uint32_t point_count;
    const char *name;    /* for messages; NULL: "points" */
    pnb_array positions; /* float[3] per point, metres in object space */
    pnb_array radii;     /* float per point, metres; absent: 0.05 */
} pnb_points_desc;

PNB_API pnb_result pnb_mesh_create_points(const pnb_points_desc *desc, pnb_mesh **mesh);

/* What was wrong with the data, naming the mesh; "" if nothing. Owned by the mesh. */
PNB_API const char *pnb_mesh_warning(const pnb_mesh *mesh);

typedef struct pnb_texture pnb_texture;

enum pnb_texture_flags {
    PNB_TEXTURE_NEAREST = 1, /* unfiltered: each texel is a square */
    PNB_TEXTURE_EXTEND = 2,  /* beyond its edges the texels at the edges go on */
    PNB_TEXTURE_CLIP = 4,    /* beyond its edges all channels are 0 */
    PNB_TEXTURE_MIRROR = 8   /* beyond its edges it is mirrored */
};

typedef struct pnb_texture_desc {
    uint32_t struct_size;
    uint32_t width, height; /* texels, 1..16384 */
    uint32_t channels;      /* floats per texel, 1..4: grey, grey + alpha, RGB, RGBA */
    uint32_t is_srgb;       /* 1: the colour channels are sRGB-encoded and are decoded to linear; alpha never is */
    uint32_t flags;         /* enum pnb_texture_flags; 0: filtered with mip maps, repeated in both directions */
    const char *name;       /* for messages; NULL: "texture" */
    pnb_array pixels;       /* `channels` floats per texel, rows bottom-up; not-finite values become 0 */
} pnb_texture_desc;

/* Copies an image. The caller owns *texture. */
PNB_API pnb_result pnb_texture_create(const pnb_texture_desc *desc, pnb_texture **texture);
PNB_API void pnb_texture_destroy(pnb_texture **texture);

/* ---- Scene ------------------------------------------------------------------------------------------------ */

enum pnb_material_flags {
    PNB_MATERIAL_CULL_CAMERA = 1,    /* the camera does not see back faces */
    PNB_MATERIAL_CULL_SHADOW = 2,    /* back faces, seen from the light, cast no shadow */
    PNB_MATERIAL_HOLDOUT = 4,        /* cuts a hole into the image: 0 with alpha 0 */
    PNB_MATERIAL_TINTED = 8,         /* what shines through is multiplied with base_color_texture, too */
    PNB_MATERIAL_NO_SHADOW = 16,     /* casts no shadow */
    PNB_MATERIAL_OPAQUE_SHADOW = 32, /* casts shadows as if it were opaque */
    PNB_MATERIAL_VERTEX_COLOR = 64   /* base_color is multiplied with the mesh's colours */
};

typedef struct pnb_material {
    uint32_t struct_size;
    float base_color[3];                   /* linear, >= 0; multiplied with the texture */
    float transparency;                    /* 0..1, 1 - alpha; alpha is multiplied with the texture's alpha */
    uint32_t flags;                        /* enum pnb_material_flags */
    const pnb_texture *base_color_texture; /* NULL: none */
    const pnb_texture *alpha_texture;      /* its alpha channel (or grey, without one) is used; NULL: none */
    float emission[3];                     /* radiance, W/(m2 sr), linear, >= 0, multiplied with the texture: seen by
                                            * the camera, but lights nothing */
    float absorption[3];                   /* 0..1, the share of each channel that is lost of the light that shines
                                            * through; 0: clear. What passes is transparency * (1 - absorption) */
    const pnb_texture *emission_texture;   /* NULL: none */
    float uv_matrix[6]; /* texture coordinates are these two rows times (u, v, 1); all zero: (u, v) */
    float shadow_threshold; /* 0..1. Above 0: the shadow is opaque where alpha is at least this, elsewhere none */
} pnb_material;

enum pnb_instance_flags {
    PNB_INSTANCE_HIDDEN_FROM_CAMERA = 1, /* casts shadows only */
    PNB_INSTANCE_NO_SHADOW = 2,          /* casts no shadow */
    PNB_INSTANCE_NO_RECEIVE = 4,         /* receives no shadow */
    PNB_INSTANCE_HOLDOUT = 8,            /* all its materials are holdouts */
    PNB_INSTANCE_SHADOW_CATCHER = 16     /* shows nothing but the shadows on it: the background darkened by them, or on
                                          * a transparent film black with their alpha; casts shadows as ever */
};

typedef struct pnb_instance {
    uint32_t struct_size;
    uint32_t flags;          /* enum pnb_instance_flags */
    const pnb_mesh *mesh;    /* not NULL */
    const char *name;        /* for messages; NULL: the mesh's name */
    uint32_t first_slot;     /* its material slots are scene.slots[first_slot .. first_slot + slot_count - 1] */
    uint32_t slot_count;     /* a mesh slot beyond the last uses the last; 0: grey 0.8, opaque */
    float matrix[16];        /* object to world; mirrored is fine; not finite: the instance is dropped with a
                              * warning; singular: it is drawn as flat as it is */
    uint64_t unlit_by;       /* light linking. Bit i: scene.lights[i] does not light it */
    uint64_t unshadowed_by;  /* shadow linking. Bit i: it casts no shadow in the light of scene.lights[i] */
} pnb_instance;

typedef enum pnb_light_type {
    PNB_LIGHT_AREA = 0,
    PNB_LIGHT_POINT = 1,
    PNB_LIGHT_SPOT = 2,
    PNB_LIGHT_SUN = 3
} pnb_light_type;
typedef enum pnb_area_shape { PNB_AREA_RECTANGLE = 0, PNB_AREA_ELLIPSE = 1 } pnb_area_shape;

enum pnb_light_flags {
    PNB_LIGHT_NO_SHADOW = 1,  /* lights, but nothing shadows it */
    PNB_LIGHT_COSINE_SPOT = 2 /* SPOT: the intensity also falls with the cosine to the axis, as from a flat disk */
};

typedef struct pnb_light {
    uint32_t struct_size;
    uint32_t flags;         /* enum pnb_light_flags */
    pnb_light_type type;
    pnb_area_shape shape;   /* AREA only */
    const char *name;       /* names the pass "Shadow.<name>"; NULL: "light" */
    float matrix[16];       /* light to world. The light shines along its local -Z. The lengths of the X and Y axes
                             * scale an AREA's sides, and the ratios to Z a SPOT's cone; nothing else */
    float emission[3];      /* linear RGB, >= 0. AREA: radiance, W/(m2 sr). POINT, SPOT: intensity, W/sr.
                             * SUN: irradiance of a surface that faces it, W/m2 */
    float size[2];          /* AREA: full width and height, metres; 0: a point-like emitter of 1e-4 m */
    float radius;           /* POINT, SPOT: metres, 0: hard */
    float angle;            /* SUN: angular diameter, 0..pi, 0: hard */
    float spot_angle;       /* SPOT: full cone angle, 0..pi; 0: pi / 4 */
    float spot_blend;       /* SPOT: 0..1, the share of the cone over which its edge fades */
    float spread;           /* AREA: full angle of the cone that each of its points shines into, as through a honeycomb
                             * grid that leaves the whole power; 0 or pi: no grid */
    const char *technique;  /* how its shadow is made; NULL or "": as pnb_settings says. Lights with and without
                             * REFERENCE may be mixed: then every anti-aliasing sample is lit anew, as for REFERENCE
                             * alone, and pnb_settings.light_samples counts for those lights that have it */
    uint32_t shadow_map_size; /* texels per side, 16..max_texture_size; 0: as pnb_settings says */
    float shadow_color[3];  /* 0..1, linear: the share of each channel that arrives in full shadow, as if the blockers
                             * let it through; 0: none. In all passes */
} pnb_light;

typedef enum pnb_projection { PNB_PERSPECTIVE = 0, PNB_ORTHOGRAPHIC = 1 } pnb_projection;

typedef struct pnb_camera {
    uint32_t struct_size;
    pnb_projection projection;
    float matrix[16];            /* camera to world; looks along its local -Z, +Y is up; scale is ignored, but a
                                  * mirrored one mirrors the image */
    float window[4];             /* left, right, bottom, top of the full image: at distance 1 (PERSPECTIVE) or in
                                  * metres (ORTHOGRAPHIC). Shift, sensor fit and pixel aspect are all in here.
                                  * All zero: 50 mm on a 36 mm sensor, or 6 m wide */
    float clip_start, clip_end;  /* metres, 0: 0.1 and 1000 */
} pnb_camera;

typedef struct pnb_scene {
    uint32_t struct_size;
    uint32_t instance_count, material_count, slot_count, light_count;
    uint32_t reserved;
    const pnb_instance *instances;
    const pnb_material *materials;
    const uint32_t *slots;         /* indices into materials; see pnb_instance.first_slot */
    const pnb_light *lights;       /* at most 64 */
    pnb_camera camera;
    float world_color[3];          /* ambient radiance, also the background */
} pnb_scene;

/* ---- Techniques ------------------------------------------------------------------------------------------- */

typedef enum pnb_parameter_type { PNB_FLOAT = 0, PNB_INT = 1, PNB_BOOL = 2, PNB_ENUM = 3 } pnb_parameter_type;

/* All strings are static. Numbers of every type are given as double. */
typedef struct pnb_parameter_info {
    uint32_t struct_size;
    pnb_parameter_type type;
    const char *name;            /* lower_case identifier */
    const char *label;           /* for a user interface */
    const char *description;     /* what it does and what it costs */
    const char *unit;            /* "", "texels", "m", ... */
    double minimum, maximum, default_value;
    const char *const *items;    /* ENUM: identifiers of the values 0 .. item_count - 1; else NULL */
    uint32_t item_count;
    uint32_t reserved;
} pnb_parameter_info;

typedef struct pnb_technique_info {
    uint32_t struct_size;
    uint32_t parameter_count;
    const char *id;              /* upper-case identifier such as "PCSS" */
    const char *label;
    const char *description;     /* one line */
    const char *paper;           /* author, title, year */
} pnb_technique_info;

PNB_API uint32_t pnb_technique_count(void);
/* info->struct_size must be set. INVALID_ARGUMENT beyond the count. */
PNB_API pnb_result pnb_technique_get_info(uint32_t technique, pnb_technique_info *info);
PNB_API pnb_result pnb_technique_get_parameter(uint32_t technique, uint32_t parameter, pnb_parameter_info *info);

/* ---- Rendering -------------------------------------------------------------------------------------------- */

enum pnb_pass {
    PNB_PASS_COMBINED = 1,     /* "Combined", RGBA, premultiplied linear radiance */
    PNB_PASS_DEPTH = 2,        /* "Depth", 1 channel, metres along the camera axis; 1e10 where there is nothing */
    PNB_PASS_NORMAL = 4,       /* "Normal", 3 channels, world space; 0 where there is nothing */
    PNB_PASS_SHADOW = 8,       /* "Shadow", RGB, shadowed over unshadowed irradiance; 1 where no light reaches */
    PNB_PASS_LIGHT_SHADOWS = 16, /* "Shadow.<light name>", RGB visibility of each light, in light order */
    /* To look at how shadows come about, 1 channel for each light, of the first sample. They cost a dense search of the
     * shadow map, are the same whatever the technique, and are 0 where nothing blocks: */
    PNB_PASS_BLOCKERS = 32,     /* "Blocker.<light name>", metres from the light to the average blocker; of a SUN, from
                                 * the near end of its shadow map */
    PNB_PASS_PENUMBRAE = 64,    /* "Penumbra.<light name>", metres across the light's direction at the receiver */
    PNB_PASS_SHADOW_MAPS = 128  /* "Map.<light name>", the map itself, its layers side by side in the full image: 0 at
                                 * its near end, 1 at its far end or where there is nothing, -1 beside it */
};

enum pnb_settings_flags {
    PNB_SETTINGS_FILM_TRANSPARENT = 1, /* the background is 0 with alpha 0 instead of the world colour */
    PNB_SETTINGS_PROGRESSIVE = 2,      /* pnb_job_copy_image can show the samples made so far: after 1, 2, 4, 8 ... of
                                        * them. Only while the shadow maps of all lights fit into memory together */
    PNB_SETTINGS_QUICK = 4             /* with one sample: what the last such job of the context drew is used again as
                                        * far as it serves. Shadows then depend on it within a texel or two */
};

/* A parameter by name: "filter_samples" is that of pnb_settings.technique, "ESSM.subdivision" that of the technique
 * named, for lights that have it. Of one technique all lights have the same values. INT, BOOL and ENUM values are
 * rounded. Beyond its range: clamped, with a warning in the job. An unknown name: INVALID_ARGUMENT. */
typedef struct pnb_value {
    const char *name;
    double value;
} pnb_value;

#define PNB_DEFAULT_SAMPLES       1
#define PNB_DEFAULT_MAP_SIZE      1024
#define PNB_DEFAULT_LIGHT_SAMPLES 16

typedef struct pnb_settings {
    uint32_t struct_size;
    uint32_t flags;              /* enum pnb_settings_flags */
    const char *technique;       /* identifier; NULL: "PCSS"; of lights that have none of their own */
    const pnb_value *values;     /* parameters that differ from their defaults */
    uint32_t value_count;
    uint32_t width, height;      /* pixels of the full image, 1 .. max_texture_size */
    uint32_t crop[4];            /* x, y, width, height, from the lower left: only these pixels are made, and they
                                  * equal those of the full image. Width 0: the full image */
    uint32_t samples;            /* anti-aliasing samples per pixel, 1..4096, 0: PNB_DEFAULT_SAMPLES. One sample is at
                                  * pixel centres */
    float filter_width;          /* pixels, of the Blackman-Harris filter the samples follow, below 100; 0: 1.5 */
    uint32_t shadow_map_size;    /* texels per side, 16..max_texture_size; 0: PNB_DEFAULT_MAP_SIZE */
    uint32_t light_samples;      /* REFERENCE: N for N x N light samples, 1..64; 0: PNB_DEFAULT_LIGHT_SAMPLES */
    uint32_t passes;             /* enum pnb_pass; 0: all but LIGHT_SHADOWS */
} pnb_settings;

typedef struct pnb_job pnb_job;

typedef struct pnb_progress {
    uint32_t struct_size;
    float fraction;              /* 0..1, never falls */
    uint32_t sample, samples;    /* anti-aliasing samples done and wanted */
    char text[104];              /* what is being done, for a status line */
} pnb_progress;

typedef struct pnb_image {
    uint32_t struct_size;
    uint32_t width, height;      /* pixels, the crop's */
    uint32_t channels;           /* 1, 3 or 4 */
    const char *name;            /* pass name */
    const float *pixels;         /* width * height * channels, rows bottom-up, tightly packed; owned by the job */
} pnb_image;

typedef struct pnb_timing {
    uint32_t struct_size;
    uint32_t count;              /* times the pass ran in this job */
    const char *name;            /* owned by the job */
    double gpu_ms, cpu_ms;       /* summed: OpenGL timer queries, and the CPU time to record */
    uint64_t bytes;              /* of textures and buffers it owns */
} pnb_timing;

/* Checks the description, copies what it needs and queues the render. Jobs of one context run in order. The scene
 * may be changed or freed at once. The caller owns *job.
 * Errors: INVALID_ARGUMENT, UNSUPPORTED (size beyond the limits), OUT_OF_MEMORY, FORKED, CONTEXT_LOST. */
PNB_API pnb_result pnb_render_start(pnb_context *context, const pnb_scene *scene, const pnb_settings *settings,
                                    pnb_job **job);
/* Waits up to timeout_ms (UINT32_MAX: for ever, 0: polls) and reports progress (may be NULL; struct_size set).
 * Returns PNB_OK when the images are ready, PNB_TIMEOUT, or the error that ended the job. */
PNB_API pnb_result pnb_job_wait(pnb_job *job, uint32_t timeout_ms, pnb_progress *progress);
/* Asks the job to end soon; it then reports PNB_ERROR_CANCELLED unless it was already done. */
PNB_API void pnb_job_cancel(pnb_job *job);
/* Cancels, waits and frees. */
PNB_API void pnb_job_destroy(pnb_job **job);
/* pnb_render_start and pnb_job_wait in one; on error *job is not written. */
PNB_API pnb_result pnb_render(pnb_context *context, const pnb_scene *scene, const pnb_settings *settings,
                              pnb_job **job);

/* Results of a finished job. Images are in the order of enum pnb_pass. Index beyond the count: INVALID_ARGUMENT. */
PNB_API uint32_t pnb_job_image_count(const pnb_job *job);
PNB_API pnb_result pnb_job_get_image(const pnb_job *job, uint32_t index, pnb_image *image);
/* Copies an image of a finished job, or, of a running PROGRESSIVE one, the mean of its first *samples samples.
 * PNB_TIMEOUT: there is none yet, nothing is written. `capacity`: floats `pixels` has room for, at least those of the
 * image. `pixels` NULL: only the number of samples is wanted. `samples` may be NULL. */
PNB_API pnb_result pnb_job_copy_image(const pnb_job *job, uint32_t index, float *pixels, uint64_t capacity,
                                      uint32_t *samples);
PNB_API uint32_t pnb_job_timing_count(const pnb_job *job);
PNB_API pnb_result pnb_job_get_timing(const pnb_job *job, uint32_t index, pnb_timing *timing);
/* Warnings about the scene, naming objects. Owned by the job; "" beyond the count. Readable while rendering. */
PNB_API uint32_t pnb_job_message_count(const pnb_job *job);
PNB_API const char *pnb_job_message(const pnb_job *job, uint32_t index);

/* ---- Captures --------------------------------------------------------------------------------------------- */

typedef struct pnb_capture pnb_capture;

/* Writes a scene and its settings to a .pnb file, complete or not at all (a temporary file is renamed). */
PNB_API pnb_result pnb_capture_write(const char *path, const pnb_scene *scene, const pnb_settings *settings);
/* Reads one. A truncated or damaged file is PNB_ERROR_FILE. The caller owns *capture. */
PNB_API pnb_result pnb_capture_read(const char *path, pnb_capture **capture);
/* The description inside, valid until the capture is destroyed; NULL for NULL. Copy it to change it. */
PNB_API const pnb_scene *pnb_capture_scene(const pnb_capture *capture);
PNB_API const pnb_settings *pnb_capture_settings(const pnb_capture *capture);
PNB_API void pnb_capture_destroy(pnb_capture **capture);

#ifdef __cplusplus
}
#endif

#endif
