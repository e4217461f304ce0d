/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs this program anew with another environment, which drivers and the dynamic linker read only at the start. */
#ifndef SPAWN_H
#define SPAWN_H

#include "support.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#define SPAWN_MAX_VARIABLES 8

struct spawn {
    const char *argument;                       /* of the new program */
    const char *variables[SPAWN_MAX_VARIABLES]; /* "NAME=value", ended by NULL */
    rlim_t address_space;                       /* bytes; 0: unlimited */
    rlim_t stack;                               /* bytes of every thread's stack by default; 0: as it is */
};

static inline void become(const struct spawn *spawn, int output) {
    for (int i = 0; i < SPAWN_MAX_VARIABLES && spawn->variables[i]; ++i) {
        putenv((char *)spawn->variables[i]);
    }
    dup2(output, STDOUT_FILENO);
    dup2(output, STDERR_FILENO);
    alarm(300); /* a hang is a failure */
    if (spawn->address_space) {
        setrlimit(RLIMIT_AS, &(struct rlimit){spawn->address_space, spawn->address_space});
    }
    if (spawn->stack) {
        setrlimit(RLIMIT_STACK, &(struct rlimit){spawn->stack, spawn->stack});
    }
    execl("/proc/self/exe", "test", spawn->argument, (char *)NULL);
    _exit(127);
}

/* Runs it, keeps what it printed, and gives its exit status as waitpid does. */
static inline int spawn_self(const struct spawn *spawn, char *output, size_t size) {
    int ends[2], status = -1;
    size_t length = 0;
    fflush(stdout);
    if (pipe(ends) != 0) {
        return -1;
    }
    pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        become(spawn, ends[1]);
    }
    close(ends[1]);
    for (ssize_t count = 1; count > 0;) {
        char rest[256];
        bool full = length >= size - 1;
        count = read(ends[0], full ? rest : output + length, full ? sizeof rest : size - 1 - length);
        length += !full && count > 0 ? (size_t)count : 0;
    }
    output[length] = '\0';
    close(ends[0]);
    waitpid(child, &status, 0);
    return status;
}

#endif
