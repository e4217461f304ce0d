/* SPDX-License-Identifier: GPL-3.0-or-later
 * Captures with arbitrary damage but the right checksum: they are refused, or they are written back byte for byte
 * and their scene can be copied; nothing leaks. As a test it runs a fixed sequence of mutations. As a libFuzzer
 * target it is built with clang -fsanitize=fuzzer,address,undefined -DPNB_LIBFUZZER from this file, the files of
 * core/scene, core/error.c, core/memory.c and core/messages.c; any captures are a corpus. */
#include "memory.h"
#include "scene/capture.h"
#include "scene/content_key.h"

#include <stdlib.h>
#include <string.h>

/* Gives the data the header that its content asks for. */
static void correct_header(unsigned char *data, size_t size) {
    const uint32_t version = CAPTURE_VERSION;
    const uint64_t file_size = size;
    struct content_key key = {{0}};
    content_key_add(&key, data + CAPTURE_HEADER_SIZE, size - CAPTURE_HEADER_SIZE);
    memcpy(data, "PNB1", 4);
    memcpy(data + 4, &version, sizeof version);
    memcpy(data + 8, &file_size, sizeof file_size);
    memcpy(data + CAPTURE_KEY_OFFSET, &key, sizeof key);
}

/* What must hold for a capture that was accepted. */
static bool is_sound(const pnb_capture *capture, const unsigned char *data, size_t size) {
    struct byte_writer file = {0};
    bool sound = capture_encode(pnb_capture_scene(capture), pnb_capture_settings(capture), &file) == PNB_OK &&
                 file.size == size && memcmp(file.data, data, size) == 0;
    memory_free(file.data);
    struct messages messages;
    struct scene *scene = NULL;
    messages_init(&messages);
    sound = scene_create(pnb_capture_scene(capture), &messages, &scene) == PNB_OK && sound;
    scene_destroy(&scene);
    messages_free(&messages);
    return sound;
}

enum outcome { REFUSED, ACCEPTED, WRONG };

/* `data` gets a correct header. */
static enum outcome try_capture(unsigned char *data, size_t size) {
    int64_t before = memory_live_blocks();
    pnb_capture *capture = NULL;
    if (size >= CAPTURE_HEADER_SIZE) {
        correct_header(data, size);
    }
    pnb_result result = capture_decode(data, size, &capture);
    enum outcome outcome = REFUSED;
    if (result == PNB_OK) {
        outcome = is_sound(capture, data, size) ? ACCEPTED : WRONG;
    } else if (result != PNB_ERROR_FILE || capture || pnb_last_error()[0] == '\0') {
        outcome = WRONG;
    }
    pnb_capture_destroy(&capture);
    return memory_live_blocks() == before ? outcome : WRONG;
}

#ifdef PNB_LIBFUZZER

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    unsigned char *copy = malloc(size ? size : 1);
    if (copy) {
        memcpy(copy, data, size);
        if (try_capture(copy, size) == WRONG) {
            abort();
        }
        free(copy);
    }
    return 0;
}

#else

#include "../unit/example_scene.h"
#include "check.h"

#define CASES 8000

/* xorshift64: the same sequence everywhere. */
static uint64_t random_state = 0x9e3779b97f4a7c15u;

static uint64_t random_below(uint64_t limit) {
    random_state ^= random_state << 13;
    random_state ^= random_state >> 7;
    random_state ^= random_state << 17;
    return random_state % limit;
}

/* Numbers at which checks go wrong. */
static uint32_t interesting_number(void) {
    static const uint32_t numbers[] = {0,      1,          2,          3,          4,          0x7f,       0xff,
                                       0x7fff, 0xffff,     0x7fffffff, 0x80000000, 0xfffffffe, 0xffffffff, 0x3f800000,
                                       100,    0x7f800000, 0x7fc00000, 0xff800000, 0x5d5e0b6b, 16384};
    return numbers[random_below(sizeof numbers / sizeof *numbers)];
}

/* One change of the bytes behind the header; the size may shrink. */
static void mutate(unsigned char *data, size_t *size) {
    size_t payload = *size - CAPTURE_HEADER_SIZE;
    if (payload < 8) {
        return;
    }
    unsigned char *at = data + CAPTURE_HEADER_SIZE + random_below(payload - 7);
    switch (random_below(6)) {
    case 0:
        *at ^= (unsigned char)(1u << random_below(8));
        break;
    case 1:
        *at = (unsigned char)random_below(256);
        break;
    case 2:
    case 3: {
        uint32_t number = interesting_number();
        memcpy(at, &number, sizeof number);
        break;
    }
    case 4: { /* a small step: counts and lengths off by one */
        uint32_t number;
        memcpy(&number, at, sizeof number);
        number += (uint32_t)random_below(5) - 2;
        memcpy(at, &number, sizeof number);
        break;
    }
    default: { /* bytes from elsewhere, or gone */
        const unsigned char *from = data + CAPTURE_HEADER_SIZE + random_below(payload - 7);
        size_t left = (size_t)(data + *size - (from > at ? from : at)), count = random_below(left < 64 ? left : 64);
        memmove(at, from, count);
        if (random_below(4) == 0) {
            *size -= random_below(16);
        }
    }
    }
}

int main(void) {
    struct example example;
    struct byte_writer file = {0};
    unsigned counts[3] = {0};
    if (!CHECK_RESULT(example_create(&example), PNB_OK) ||
        !CHECK_RESULT(capture_encode(&example.scene, &example.settings, &file), PNB_OK)) {
        return check_report();
    }
    for (int i = 0; i < CASES; i++) {
        size_t size = file.size;
        unsigned char *copy = malloc(size);
        if (!CHECK(copy != NULL)) {
            break;
        }
        memcpy(copy, file.data, size);
        for (uint64_t changes = i == 0 ? 0 : 1 + random_below(3); changes > 0; changes--) {
            mutate(copy, &size);
        }
        unsigned char *exact = realloc(copy, size); /* so that a sanitizer sees the first byte beyond */
        enum outcome outcome = try_capture(exact ? exact : copy, size);
        counts[outcome]++;
        CHECK(outcome != WRONG);
        free(exact ? exact : copy);
    }
    memory_free(file.data);
    example_destroy(&example);
    CHECK_INT(memory_live_blocks(), 0);
    /* Both kinds must be frequent for the run to mean anything. */
    CHECK(counts[REFUSED] > CASES / 10);
    CHECK(counts[ACCEPTED] > CASES / 10);
    printf("%d mutated captures: %u refused, %u accepted and written back exactly\n", CASES, counts[REFUSED],
           counts[ACCEPTED]);
    return check_report();
}

#endif
