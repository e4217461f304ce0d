/* SPDX-License-Identifier: GPL-3.0-or-later
 * Growing byte buffers and bounds-checked reading of them. Numbers are little-endian. */
#ifndef PNB_BYTES_H
#define PNB_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "captures are copied as they lie in memory");

/* Length of a string that is NULL. */
#define STRING_ABSENT UINT32_MAX

/* Once memory is missing, `failed` is set and nothing more is written. */
struct byte_writer {
    unsigned char *data; /* owned: memory_free */
    size_t size, capacity;
    bool failed;
};

void write_bytes(struct byte_writer *writer, const void *data, size_t size);
void write_u32(struct byte_writer *writer, uint32_t value);
/* Length and characters. Strings are shorter than 4 GiB. */
void write_string(struct byte_writer *writer, const char *text);

/* Once something is read beyond the end, `failed` is set and everything reads as zero. */
struct byte_reader {
    const unsigned char *next;
    size_t left;
    bool failed;
};

void read_bytes(struct byte_reader *reader, void *data, size_t size);
uint32_t read_u32(struct byte_reader *reader);
/* Takes `size` bytes off as a reader of their own. */
struct byte_reader read_part(struct byte_reader *reader, uint64_t size);

#endif
