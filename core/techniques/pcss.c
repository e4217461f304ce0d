/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "technique.h"

#include <math.h>

enum { PATTERN, BLOCKER_SAMPLES, FILTER_SAMPLES, BLOCKER_AVERAGE, SEARCH_REDUCTION, MIN_MAX };

static const char *const patterns[] = {"VOGEL", "GRID", NULL};

static const char *const averages[] = {"AREA", "EQUAL", NULL};

static const struct parameter parameters[] = {
    [PATTERN] = {.name = "pattern",
                 .label = "Pattern",
                 .description = "VOGEL: evenly spread points whose projections never coincide, free of bands. GRID: "
                                "the regular grid of the papers, the largest square number of points within the count",
                 .unit = "",
                 .type = PNB_ENUM,
                 .maximum = 1,
                 .default_value = PATTERN_VOGEL,
                 .items = patterns},
    [BLOCKER_SAMPLES] = {.name = "blocker_samples",
                         .label = "Blocker Samples",
                         .description = "Points of the blocker search; too few miss thin casters (papers: 9 x 9 = 81)",
                         .unit = "",
                         .type = PNB_INT,
                         .minimum = 1,
                         .maximum = MAX_TAPS,
                         .default_value = 32},
    [FILTER_SAMPLES] = {.name = "filter_samples",
                        .label = "Filter Samples",
                         .description = "Points of the penumbra filter; each is one shade of grey (papers: "
                                        "15 x 15 = 225). Every four anti-aliasing samples share them, down to 16 each",
                        .unit = "",
                        .type = PNB_INT,
                        .minimum = 1,
                        .maximum = MAX_TAPS,
                        .default_value = 64},
    [BLOCKER_AVERAGE] = {.name = "blocker_average",
                         .label = "Blocker Average",
                          .description = "AREA: a blocker counts by the share of the light it hides. EQUAL: all count "
                                         "the same, as in the paper; thin casters near the light then widen every "
                                         "penumbra",
                         .unit = "",
                         .type = PNB_ENUM,
                         .maximum = 1,
                         .items = averages},
    [SEARCH_REDUCTION] = {.name = "search_reduction",
                          .label = "Search Reduction",
                          .description = "Times the search area is shrunk to what the nearest blocker in it needs; 0: "
                                         "from the near plane, as in the paper",
                          .unit = "",
                          .type = PNB_INT,
                          .maximum = 4,
                          .default_value = 2},
    [MIN_MAX] = {.name = SKIP_PARAMETER,
                 .label = "Min-Max Skip",
                 .description = "Skips pixels that the min-max pyramid shows to be fully lit or fully shadowed; "
                                "faster, same image",
                 .unit = "",
                 .type = PNB_BOOL,
                 .maximum = 1,
                 .default_value = 1},
    {0}};

/* The samples of a pixel share the points: each takes a part of them, turned against the others', but no less than
 * what finds thin casters and keeps one sample from banding. */
static int shared_count(double count, uint32_t samples) {
    const double least = 16.0;
    const double share = ceil(count / (double)samples);
    return (int)fmin(count, fmax(share, least));
}

static void pcss_taps(const double *values, bool ellipse, uint32_t sample, uint32_t samples, struct taps *taps) {
    const enum pattern pattern = (enum pattern)values[PATTERN];
    taps->search_count =
        pattern_fill(pattern, shared_count(values[BLOCKER_SAMPLES], samples), ellipse, sample, taps->search);
    taps->filter_count =
        pattern_fill(pattern, shared_count(values[FILTER_SAMPLES], samples), ellipse, sample, taps->filter);
}

const struct technique technique_pcss = {
    .id = "PCSS",
    .label = "Percentage-Closer Soft Shadows",
    .description = "Penumbrae as wide as the light's size and the average blocker make them",
    .paper = "R. Fernando, Percentage-Closer Soft Shadows, 2005",
    .parameters = parameters,
    .needs = NEEDS_MIN_MAX,
    .shader = "tech_pcss.glsl",
    .taps = pcss_taps,
};
