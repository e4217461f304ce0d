/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fast 128-bit hash of content. Not cryptographic: it finds changes and damage, not forgery. */
#ifndef PNB_CONTENT_KEY_H
#define PNB_CONTENT_KEY_H

#include "scene.h"

#include <stddef.h>

/* Mixes a block and its length into the key. Start with a zeroed key; the order and the borders of blocks count. */
void content_key_add(struct content_key *key, const void *data, size_t size);

/* A number every bit of which depends on every bit of `word`; different for different words. */
uint64_t content_key_mix(uint64_t word);

static inline bool content_key_equal(const struct content_key *a, const struct content_key *b) {
    return a->words[0] == b->words[0] && a->words[1] == b->words[1];
}

#endif
