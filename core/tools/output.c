/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

bool output_check(const char *path) {
    const char *slash = strrchr(path, '/');
    char *folder = slash ? strndup(path, (size_t)(slash - path) + 1) : strdup(".");
    bool good = folder && access(folder, W_OK | X_OK) == 0;
    if (!good)
        tool_error("cannot write %s: %s", path, strerror(errno));
    free(folder);
    return good;
}

bool output_begin(struct output *output, const char *path) {
    output->path = path;
    if (asprintf(&output->temporary, "%s.XXXXXX", path) < 0) {
        output->temporary = NULL;
        return tool_error("out of memory");
    }
    int file = mkstemp(output->temporary);
    if (file < 0) {
        tool_error("cannot write %s: %s", path, strerror(errno));
        free(output->temporary);
        return false;
    }
    /* mkstemp makes the file private; give it the mode any new file has. */
    mode_t mask = umask(0);
    umask(mask);
    fchmod(file, 0666 & ~mask);
    close(file);
    return true;
}

bool output_end(struct output *output, bool complete) {
    if (complete && rename(output->temporary, output->path) != 0)
        complete = tool_error("cannot write %s: %s", output->path, strerror(errno));
    if (!complete)
        unlink(output->temporary);
    free(output->temporary);
    output->temporary = NULL;
    return complete;
}
