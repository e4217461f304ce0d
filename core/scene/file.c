/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "file.h"
#include "../memory.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* As many bytes are moved by one call; Linux moves no more than 2 GiB. */
#define LARGEST_TRANSFER ((size_t)1 << 30)

static pnb_result cannot(const char *action, const char *path) {
    return error_set(PNB_ERROR_FILE, "cannot %s '%s': %s", action, path, strerror(errno));
}

pnb_result file_open(const char *path, int *descriptor, uint64_t *size) {
    /* Not blocking: a pipe that nobody writes to must not hang the host before it is found to be no file. */
    int opened = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (opened < 0) {
        return cannot("open", path);
    }
    struct stat status;
    if (fstat(opened, &status) != 0 || !S_ISREG(status.st_mode)) {
        close(opened);
        return error_set(PNB_ERROR_FILE, "cannot read '%s': it is not a regular file", path);
    }
    *descriptor = opened;
    *size = (uint64_t)status.st_size;
    return PNB_OK;
}

pnb_result file_read(int descriptor, const char *path, void *data, size_t size) {
    for (size_t done = 0; done < size;) {
        size_t wanted = size - done < LARGEST_TRANSFER ? size - done : LARGEST_TRANSFER;
        ssize_t count = read(descriptor, (char *)data + done, wanted);
        if (count < 0 && errno != EINTR) {
            return cannot("read", path);
        }
        if (count == 0) {
            return error_set(PNB_ERROR_FILE, "cannot read '%s': it is truncated", path);
        }
        done += count > 0 ? (size_t)count : 0;
    }
    return PNB_OK;
}

static bool write_all(int descriptor, const void *data, size_t size) {
    for (size_t done = 0; done < size;) {
        size_t wanted = size - done < LARGEST_TRANSFER ? size - done : LARGEST_TRANSFER;
        ssize_t count = write(descriptor, (const char *)data + done, wanted);
        if (count < 0 && errno != EINTR) {
            return false;
        }
        done += count > 0 ? (size_t)count : 0;
    }
    return true;
}

/* Creates a file beside `path` that did not exist; its name is put into `name`. */
static int create_beside(const char *path, char *name, size_t size) {
    static atomic_uint counter;
    int descriptor;
    do {
        unsigned number = atomic_fetch_add_explicit(&counter, 1, memory_order_relaxed);
        snprintf(name, size, "%s.%ld-%u.tmp", path, (long)getpid(), number);
        descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    } while (descriptor < 0 && errno == EEXIST);
    return descriptor;
}

/* After a crash the renamed file should still be there; a file system that cannot do this is no reason to fail.
 * `name`, of a file in the folder, is cut. */
static void sync_folder(char *name) {
    char *slash = strrchr(name, '/');
    if (slash) {
        slash[slash == name] = '\0';
    }
    int descriptor = open(slash ? name : ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (descriptor >= 0) {
        fsync(descriptor);
        close(descriptor);
    }
}

static bool write_and_rename(int descriptor, const char *name, const char *path, const void *data, size_t size) {
    bool written = write_all(descriptor, data, size) && fsync(descriptor) == 0;
    int reason = errno;
    bool closed = close(descriptor) == 0; /* may be the first to report an error */
    if (!written) {
        errno = reason;
    }
    return written && closed && rename(name, path) == 0;
}

pnb_result file_replace(const char *path, const void *data, size_t size) {
    struct stat status;
    if (stat(path, &status) == 0 && !S_ISREG(status.st_mode)) {
        return error_set(PNB_ERROR_FILE, "cannot write '%s': it is not a regular file", path);
    }
    size_t name_size = strlen(path) + 64;
    char *name = memory_array(name_size, 1);
    if (!name) {
        return PNB_ERROR_OUT_OF_MEMORY;
    }
    pnb_result result = PNB_OK;
    int descriptor = create_beside(path, name, name_size);
    if (descriptor < 0) {
        result = cannot("write", path);
    } else if (!write_and_rename(descriptor, name, path, data, size)) {
        result = cannot("write", path);
        unlink(name);
    } else {
        sync_folder(name);
    }
    memory_free(name);
    return result;
}
