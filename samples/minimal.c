/* SPDX-License-Identifier: GPL-3.0-or-later
 *
 * The smallest use of the library: a square floats over a floor, an area light shines on both, PCSS renders it. Writes
 * the shadow pass as minimal.ppm. From the repository's root, after building:
 *
 *   cc -Icore/include samples/minimal.c -Lbuild -lpenumbra -Wl,-rpath,build -o build/minimal && build/minimal */
#include <penumbra.h>
#include <stdio.h>

static int fail(const char *what) {
    fprintf(stderr, "%s: %s\n", what, pnb_last_error());
    return 1;
}

static int write_ppm(const char *path, const pnb_image *image) {
    FILE *file = fopen(path, "wb");
    if (!file)
        return 0;
    fprintf(file, "P6 %u %u 255\n", image->width, image->height);
    for (uint32_t y = image->height; y-- > 0;) { /* rows are bottom-up, PPM's are top-down */
        for (uint32_t i = 0; i < 3 * image->width; i++)
            fputc((int)(image->pixels[3 * (size_t)y * image->width + i] * 255.0f + 0.5f), file);
    }
    return fclose(file) == 0;
}

int main(void) {
    static const float corners[4][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    static const uint32_t triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
    pnb_mesh_desc square = PNB_INIT(pnb_mesh_desc);
    square.vertex_count = square.corner_count = 4;
    square.triangle_count = 2;
    square.positions.data = corners;
    square.triangles.data = triangles;
    pnb_mesh *mesh = NULL;
    if (pnb_mesh_create(&square, &mesh) != PNB_OK)
        return fail("mesh");

    pnb_instance instances[2] = {
        {.struct_size = sizeof(pnb_instance), .mesh = mesh, .matrix = {5, 0, 0, 0, 0, 5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
        {.struct_size = sizeof(pnb_instance),
         .mesh = mesh,
         .matrix = {.5f, 0, 0, 0, 0, .5f, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1}},
    };
    pnb_light light = {.struct_size = sizeof(pnb_light),
                       .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, .8f, 0, 3, 1},
                       .emission = {20, 20, 20},
                       .size = {.6f, .6f}};
    pnb_scene scene = PNB_INIT(pnb_scene);
    scene.instance_count = 2;
    scene.instances = instances;
    scene.light_count = 1;
    scene.lights = &light;
    /* A camera 4 m above the floor and 5 m in front of it, looking down by about 50 degrees. */
    const float camera[16] = {1, 0, 0, 0, 0, .64f, .768f, 0, 0, -.768f, .64f, 0, 0, -5, 4, 1};
    scene.camera.struct_size = sizeof scene.camera;
    for (int i = 0; i < 16; i++)
        scene.camera.matrix[i] = camera[i];

    pnb_settings settings = PNB_INIT(pnb_settings);
    settings.width = 640;
    settings.height = 360;
    settings.passes = PNB_PASS_SHADOW;

    pnb_context *context = NULL;
    pnb_job *job = NULL;
    pnb_image image = PNB_INIT(pnb_image);
    int status = 0;
    if (pnb_context_create(NULL, &context) != PNB_OK)
        status = fail("context");
    else if (pnb_render(context, &scene, &settings, &job) != PNB_OK || pnb_job_get_image(job, 0, &image) != PNB_OK)
        status = fail("render");
    else if (!write_ppm("minimal.ppm", &image))
        status = fail("minimal.ppm");
    pnb_job_destroy(&job);
    pnb_context_destroy(&context);
    pnb_mesh_destroy(&mesh);
    return status;
}
