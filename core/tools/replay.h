/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rendering a capture again, with changes from the command line. */
#ifndef REPLAY_H
#define REPLAY_H

#include "tool.h"

#include <getopt.h>

#define MAX_ASSIGNMENTS 64
/* The capture's and the command line's. */
#define MAX_VALUES (8 * MAX_ASSIGNMENTS)

/* What `render` and `bench` let the user change; zero keeps the capture's. */
struct replay_options {
    const char *assignments[MAX_ASSIGNMENTS]; /* -p */
    uint32_t assignment_count;
    uint32_t size[2], crop[4];
    uint32_t samples, shadow_map_size, light_samples;
    bool one_technique; /* for all lights, whatever the capture has for single ones */
    const char *backend;
    bool unshadowed, clay;
    bool verbose;
};

/* Their places in a getopt_long table, and their letters. */
#define REPLAY_LONG_OPTIONS                                                                                            \
    {"parameter", required_argument, NULL, 'p'}, {"size", required_argument, NULL, 's'},                               \
        {"samples", required_argument, NULL, 'S'}, {"map-size", required_argument, NULL, 'M'},                         \
        {"light-samples", required_argument, NULL, 'L'}, {"crop", required_argument, NULL, 'C'},                       \
        {"unshadowed", no_argument, NULL, 'U'}, {"clay", no_argument, NULL, 'Y'},                                      \
        {"backend", required_argument, NULL, 'B'}, {"verbose", no_argument, NULL, 'v'}, {                              \
        "help", no_argument, NULL, 'h'                                                                                 \
    }
#define REPLAY_SHORT_OPTIONS "p:s:vh"
/* Their help text. */
extern const char replay_help[];

/* Takes an option that getopt_long returned. False: reported, or not one of ours. */
bool replay_option(struct replay_options *options, int option, const char *argument);

struct replay {
    pnb_capture *capture;
    pnb_context *context;
    pnb_scene scene;
    pnb_light *lights;  /* of the scene, when changed; owned */
    pnb_material clay;  /* the scene's only material, when changed */
    uint32_t *slots;    /* owned */
    pnb_settings settings;
    uint32_t technique; /* index of the capture's technique */
    double context_ms;  /* time to open the context */
};

/* Reads the capture and applies the options. Returns an exit code, having reported what failed. */
int replay_open(struct replay *replay, const char *path, const struct replay_options *options);
/* Opens the context. */
int replay_start(struct replay *replay, const struct replay_options *options);
void replay_close(struct replay *replay);

/* Settings for one technique with its values in `values` (room for MAX_VALUES). False if a value is bad, which
 * is reported. With `lenient`, parameters this technique has not are passed over. */
bool replay_settings(const struct replay *replay, const struct replay_options *options, uint32_t technique,
                     bool lenient, pnb_value *values, pnb_settings *settings);

/* Renders; *milliseconds is the wall time. Ctrl-C cancels. NULL on failure, which is reported. */
pnb_job *replay_run(struct replay *replay, const pnb_settings *settings, double *milliseconds);

double milliseconds_now(void);

#endif
