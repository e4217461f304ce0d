/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "bytes.h"
#include "../memory.h"

#include <string.h>

#define FIRST_CAPACITY 4096u

static bool writer_reserve(struct byte_writer *writer, size_t size) {
    size_t capacity = writer->capacity ? writer->capacity : FIRST_CAPACITY;
    while (capacity - writer->size < size) {
        if (capacity > SIZE_MAX / 2) {
            return false;
        }
        capacity *= 2;
    }
    if (capacity > writer->capacity) {
        unsigned char *data = memory_resize(writer->data, capacity, 1);
        if (!data) {
            return false;
        }
        writer->data = data;
        writer->capacity = capacity;
    }
    return true;
}

void write_bytes(struct byte_writer *writer, const void *data, size_t size) {
    writer->failed = writer->failed || !writer_reserve(writer, size);
    if (!writer->failed && size > 0) {
        memcpy(writer->data + writer->size, data, size);
        writer->size += size;
    }
}

void write_u32(struct byte_writer *writer, uint32_t value) {
    write_bytes(writer, &value, sizeof value);
}

void write_string(struct byte_writer *writer, const char *text) {
    if (!text) {
        write_u32(writer, STRING_ABSENT);
        return;
    }
    uint32_t length = (uint32_t)strlen(text);
    write_u32(writer, length);
    write_bytes(writer, text, length);
}

void read_bytes(struct byte_reader *reader, void *data, size_t size) {
    if (reader->failed || size > reader->left) {
        reader->failed = true;
        memset(data, 0, size);
        return;
    }
    memcpy(data, reader->next, size);
    reader->next += size;
    reader->left -= size;
}

uint32_t read_u32(struct byte_reader *reader) {
    uint32_t value;
    read_bytes(reader, &value, sizeof value);
    return value;
}

struct byte_reader read_part(struct byte_reader *reader, uint64_t size) {
    if (reader->failed || size > reader->left) {
        reader->failed = true;
        return (struct byte_reader){.failed = true};
    }
    struct byte_reader part = {.next = reader->next, .left = (size_t)size};
    reader->next += part.left;
    reader->left -= part.left;
    return part;
}
