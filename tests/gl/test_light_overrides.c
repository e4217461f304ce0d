/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lights with a technique, a map size and a shadow colour of their own. Each light's shadow must be, to the last bit,
 * the one it has where all lights are made that way. */
#include "fault/room.h"

#include <math.h>
#include <stdlib.h>

#define PIXELS (80 * 60)

/* A room whose lights are told apart by what `change` does to them. */
static pnb_job *render(pnb_context *context, void (*change)(struct room *room, uint32_t turn), uint32_t turn) {
    static struct room room;
    pnb_job *job = NULL;
    room_reset(&room);
    room.settings.width = 80;
    room.settings.height = 60;
    change(&room, turn);
    CHECK_RESULT(room_make(&room), PNB_OK);
    CHECK_RESULT(pnb_render(context, &room.scene, &room.settings, &job), PNB_OK);
    room_free(&room);
    return job;
}

static pnb_image find_image(const pnb_job *job, const char *name) {
    pnb_image image = PNB_INIT(pnb_image);
    for (uint32_t i = 0; i < pnb_job_image_count(job); ++i)
        if (pnb_job_get_image(job, i, &image) == PNB_OK && strcmp(image.name, name) == 0)
            return image;
    printf("there is no pass %s\n", name);
    exit(1);
}

static long long count_different(const pnb_job *a, const pnb_job *b, const char *name) {
    const pnb_image first = find_image(a, name), second = find_image(b, name);
    long long different = 0;
    for (size_t i = 0; i < (size_t)PIXELS * first.channels; ++i)
        different += first.pixels[i] != second.pixels[i];
    return different;
}

/* ---- Techniques and map sizes ---- */

static const char *const lamps[ROOM_LAMPS] = {"Shadow.Area", "Shadow.Point", "Shadow.Spot", "Shadow.Sun"};

static const char *technique_of(uint32_t turn, uint32_t light) {
    pnb_technique_info info = PNB_INIT(pnb_technique_info);
    CHECK_RESULT(pnb_technique_get_info((turn + light) % pnb_technique_count(), &info), PNB_OK);
    return info.id;
}

/* Different for each light, a power of two for one only. */
static uint32_t map_size_of(uint32_t light) {
    return 64 + 12 * light;
}

/* Lights of another kind than the settings'. */
static void mix_techniques(struct room *room, uint32_t turn) {
    for (uint32_t i = 0; i < ROOM_LAMPS; ++i) {
        room->lights[i].technique = technique_of(turn, i);
        room->lights[i].shadow_map_size = map_size_of(i);
    }
    room->settings.technique = technique_of(turn, 5);
    room->settings.samples = turn % 2 ? 3 : 1;
}

/* All lights as the mixed room's light number `alone` is, by the settings. */
static uint32_t alone;
static void unify(struct room *room, uint32_t turn) {
    room->settings.technique = technique_of(turn, alone);
    room->settings.shadow_map_size = map_size_of(alone);
    room->settings.samples = turn % 2 ? 3 : 1;
}

static void lights_keep_their_own(pnb_context *context) {
    for (uint32_t turn = 0; turn < pnb_technique_count(); ++turn) {
        pnb_job *mixed = render(context, mix_techniques, turn);
        for (alone = 0; alone < ROOM_LAMPS; ++alone) {
            pnb_job *uniform = render(context, unify, turn);
            const long long different = count_different(mixed, uniform, lamps[alone]);
            if (!CHECK_INT(different, 0))
                printf("%s by %s\n", lamps[alone], technique_of(turn, alone));
            pnb_job_destroy(&uniform);
        }
        pnb_job_destroy(&mixed);
    }
}

/* ---- What all lights give together ---- */

static void only_one(struct room *room, uint32_t turn) {
    mix_techniques(room, turn);
    for (uint32_t i = 0; i < ROOM_LAMPS; ++i)
        if (i != alone)
            memset(room->lights[i].emission, 0, sizeof room->lights[i].emission);
    memset(room->scene.world_color, 0, sizeof room->scene.world_color);
}

static void none_in_world(struct room *room, uint32_t turn) {
    mix_techniques(room, turn);
    memset(room->scene.world_color, 0, sizeof room->scene.world_color);
}

static void sums_add_up(pnb_context *context) {
    static float sum[PIXELS];
    pnb_job *mixed = render(context, none_in_world, 4);
    for (alone = 0; alone < ROOM_LAMPS; ++alone) {
        pnb_job *one = render(context, only_one, 4);
        for (size_t i = 0; i < PIXELS; ++i)
            sum[i] += find_image(one, "Combined").pixels[4 * i];
        pnb_job_destroy(&one);
    }
    double largest = 0;
    for (size_t i = 0; i < PIXELS; ++i)
        largest = fmax(largest, fabs((double)(sum[i] - find_image(mixed, "Combined").pixels[4 * i])));
    printf("sum of the lights alone: off by up to %.2g\n", largest);
    CHECK_AT_MOST(largest, 1e-5); /* rounding of sums around 1 */
    pnb_job_destroy(&mixed);
}

/* ---- Parameters ---- */

static void qualify(struct room *room, uint32_t turn) {
    room->settings.technique = turn ? "HARD" : "PCF";
    room->values[0] = (pnb_value){turn ? "PCF.kernel_width" : "kernel_width", 17};
    room->settings.value_count = 1;
    for (uint32_t i = 0; i < ROOM_LAMPS && turn; ++i)
        room->lights[i].technique = "pcf";
}

static void parameters_reach_lights(pnb_context *context) {
    pnb_job *by_settings = render(context, qualify, 0), *by_lights = render(context, qualify, 1);
    for (uint32_t i = 0; i < ROOM_LAMPS; ++i)
        CHECK_INT(count_different(by_settings, by_lights, lamps[i]), 0);
    pnb_job_destroy(&by_settings);
    pnb_job_destroy(&by_lights);
}

/* ---- Shadow colours ---- */

static const float tint[3] = {0.75f, 0.25f, 0};

static void color_shadows(struct room *room, uint32_t turn) {
    room->scene.light_count = 1;
    if (turn)
        memcpy(room->lights[0].shadow_color, tint, sizeof tint);
}

static void shadows_are_tinted(pnb_context *context) {
    pnb_job *plain = render(context, color_shadows, 0), *tinted = render(context, color_shadows, 1);
    const char *const names[] = {"Shadow", "Shadow.Area"};
    for (int n = 0; n < 2; ++n) {
        const pnb_image v = find_image(plain, names[n]), t = find_image(tinted, names[n]);
        double largest = 0;
        float least = 1;
        for (size_t i = 0; i < (size_t)3 * PIXELS; ++i) {
            const float expected = v.pixels[i] + (1 - v.pixels[i]) * tint[i % 3];
            least = fminf(least, v.pixels[i]);
            largest = fmax(largest, fabs((double)(t.pixels[i] - expected)));
        }
        printf("%s: off the formula by up to %.2g, darkest %.2g\n", names[n], largest, (double)least);
        CHECK_AT_MOST(largest, 1e-6);
        CHECK_AT_MOST((double)least, 0.01); /* there is a shadow to be tinted */
    }
    pnb_job_destroy(&plain);
    pnb_job_destroy(&tinted);
}

int main(void) {
    pnb_context *context = NULL;
    if (!CHECK_RESULT(create_context(NULL, &context), PNB_OK))
        return check_report();
    lights_keep_their_own(context);
    sums_add_up(context);
    parameters_reach_lights(context);
    shadows_are_tinted(context);
    pnb_context_destroy(&context);
    return check_report();
}
