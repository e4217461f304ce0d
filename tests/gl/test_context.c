/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contexts: the ladder, descriptions, logging, and what must stay as it was around them. */
#include "support.h"

#include <dirent.h>
#include <fenv.h>
#include <signal.h>
#include <time.h>
#include <unistd.h>

static void every_backend_opens(void) {
    for (int i = 0; i < BACKEND_KINDS; ++i) {
        if (!backend_works(backend_kinds[i])) {
            printf("%s: not available here: %s\n", backend_kinds[i], pnb_last_error());
            continue;
        }
        struct log_record log;
        pnb_context *context = NULL;
        pnb_context_info info = PNB_INIT(pnb_context_info);
        CHECK_RESULT(create_logged(backend_kinds[i], PNB_LOG_INFO, &log, &context), PNB_OK);
        CHECK_RESULT(pnb_context_get_info(context, &info), PNB_OK);
        printf("%s: %s, %s, OpenGL %u.%u, GLSL %s, textures up to %u\n", info.backend, info.vendor, info.renderer,
               info.gl_major, info.gl_minor, info.shading_language, info.max_texture_size);
        CHECK(strncmp(info.backend, backend_kinds[i], strlen(backend_kinds[i])) == 0);
        CHECK(info.gl_major * 10 + info.gl_minor >= 43);
        CHECK(info.max_texture_size >= 8192);
        CHECK(info.renderer[0] && info.vendor[0] && info.version[0] && info.shading_language[0]);
        CHECK_INT(info.is_software, strstr(info.renderer, "llvmpipe") != NULL);
        CHECK_INT(log.count[PNB_LOG_INFO], 1);
        CHECK_INT(log.count[PNB_LOG_WARNING] + log.count[PNB_LOG_ERROR], 0);
        CHECK_CONTAINS(log.text, info.backend);
        CHECK_CONTAINS(log.text, info.renderer);
        pnb_context_destroy(&context);
        CHECK(context == NULL);
        pnb_context_destroy(&context);
    }
    pnb_context_destroy(NULL);
}

static void bad_descriptions_are_refused(void) {
    pnb_context *const untouched = (pnb_context *)&check_report;
    pnb_context *context = untouched;
    pnb_context_desc desc = PNB_INIT(pnb_context_desc);
    CHECK_RESULT(pnb_context_create(&desc, NULL), PNB_ERROR_INVALID_ARGUMENT);
    static const uint32_t sizes[] = {0, 4, sizeof desc - 1, sizeof desc + 8, UINT32_MAX};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; ++i) {
        desc.struct_size = sizes[i];
        CHECK_RESULT(pnb_context_create(&desc, &context), PNB_ERROR_INVALID_ARGUMENT);
        CHECK_CONTAINS(pnb_last_error(), "pnb_context_desc.struct_size");
    }
    desc.struct_size = sizeof desc;
    static const char *const names[] = {"gpu",     "EGL",        "egl:", "egl:x",  "egl:1x",
                                        "egl:-1",  "egl:+1",     "egl0", " egl",   "egl:99999",
                                        "osmesa8", "surfaceles", "x11",  "egl: 0", "egl,osmesa"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; ++i) {
        desc.backend = names[i];
        CHECK_RESULT(pnb_context_create(&desc, &context), PNB_ERROR_INVALID_ARGUMENT);
        CHECK_CONTAINS(pnb_last_error(), names[i]);
    }
    desc.backend = "egl:1000";
    CHECK_RESULT(pnb_context_create(&desc, &context), PNB_ERROR_NO_BACKEND);
    CHECK_CONTAINS(pnb_last_error(), "egl:1000");
    CHECK(context == untouched);
}

static void environment_names_the_backend(void) {
    pnb_context *context = NULL;
    setenv("PENUMBRA_BACKEND", "vulkan", 1);
    CHECK_RESULT(pnb_context_create(NULL, &context), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "PENUMBRA_BACKEND");
    for (int i = 0; i < BACKEND_KINDS; ++i) {
        if (!backend_works(backend_kinds[i])) {
            continue;
        }
        pnb_context_info info = PNB_INIT(pnb_context_info);
        setenv("PENUMBRA_BACKEND", backend_kinds[i], 1);
        CHECK_RESULT(create_context("", &context), PNB_OK);
        pnb_context_get_info(context, &info);
        CHECK(strncmp(info.backend, backend_kinds[i], strlen(backend_kinds[i])) == 0);
        pnb_context_destroy(&context);
        /* The description wins over the environment. */
        setenv("PENUMBRA_BACKEND", "vulkan", 1);
        CHECK_RESULT(create_context(backend_kinds[i], &context), PNB_OK);
        pnb_context_destroy(&context);
    }
    setenv("PENUMBRA_BACKEND", "", 1);
    CHECK_RESULT(pnb_context_create(NULL, &context), PNB_OK);
    pnb_context_destroy(&context);
    unsetenv("PENUMBRA_BACKEND");
}

static void probe_lists_the_ladder(void) {
    pnb_backend_attempt attempts[8];
    uint32_t count = 0;
    for (int i = 0; i < 8; ++i) {
        attempts[i] = (pnb_backend_attempt)PNB_INIT(pnb_backend_attempt);
    }
    CHECK_RESULT(pnb_probe_backends(attempts, 8, &count), PNB_OK);
    CHECK(count >= 3);
    for (uint32_t i = 0; i < count && i < 8; ++i) {
        const pnb_backend_attempt *attempt = &attempts[i];
        printf("probe %s: %s %s %s %s\n", attempt->backend, pnb_result_name(attempt->result), attempt->message,
               attempt->renderer, attempt->version);
        bool works = attempt->result == PNB_OK;
        CHECK_INT(works, attempt->message[0] == '\0');
        CHECK_INT(works, attempt->renderer[0] != '\0');
        CHECK_INT(works, attempt->version[0] != '\0');
    }
    CHECK_STRING(attempts[count - 1].backend, "osmesa");
    CHECK_STRING(attempts[count - 2].backend, "surfaceless");
    uint32_t again = 0;
    CHECK_RESULT(pnb_probe_backends(NULL, 0, &again), PNB_OK);
    CHECK_INT(again, count);
    CHECK_RESULT(pnb_probe_backends(attempts, 8, NULL), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_probe_backends(NULL, 1, &again), PNB_ERROR_INVALID_ARGUMENT);
    attempts[3].struct_size = 12;
    CHECK_RESULT(pnb_probe_backends(attempts, 8, &again), PNB_ERROR_INVALID_ARGUMENT);
}

static void info_checks_its_arguments(void) {
    pnb_context *context = NULL;
    pnb_context_info info = PNB_INIT(pnb_context_info);
    CHECK_RESULT(pnb_context_get_info(NULL, &info), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_RESULT(pnb_context_create(NULL, &context), PNB_OK);
    CHECK_RESULT(pnb_context_get_info(context, NULL), PNB_ERROR_INVALID_ARGUMENT);
    info.struct_size += 4;
    CHECK_RESULT(pnb_context_get_info(context, &info), PNB_ERROR_INVALID_ARGUMENT);
    CHECK_CONTAINS(pnb_last_error(), "pnb_context_info");
    pnb_context_destroy(&context);
}

static void log_level_is_kept(void) {
    struct log_record log;
    pnb_context *context = NULL;
    for (int level = PNB_LOG_NONE; level <= PNB_LOG_DEBUG; ++level) {
        CHECK_RESULT(create_logged(NULL, (pnb_log_level)level, &log, &context), PNB_OK);
        pnb_context_destroy(&context);
        CHECK_INT(log.count[PNB_LOG_INFO], level >= PNB_LOG_INFO ? 1 : 0);
        CHECK(level == PNB_LOG_DEBUG || log.count[PNB_LOG_DEBUG] == 0);
    }
    CHECK_RESULT(create_logged("egl:1000", PNB_LOG_ERROR, &log, &context), PNB_ERROR_NO_BACKEND);
    CHECK_INT(log.count[PNB_LOG_ERROR], 1);
    CHECK_CONTAINS(log.text, "egl:1000");
}

/* The thread must start with the default floating-point modes and no signals, whatever its creator has. */
static void creator_keeps_its_modes(const sigset_t *before) {
    pnb_context *context = NULL;
    sigset_t after;
    fenv_t modes;
    fegetenv(&modes);
    fesetround(FE_UPWARD);
    feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    CHECK_RESULT(pnb_context_create(NULL, &context), PNB_OK);
    pthread_sigmask(SIG_BLOCK, NULL, &after);
    CHECK_INT(fegetround(), FE_UPWARD);
    CHECK_INT(fegetexcept(), FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW);
    pnb_context_destroy(&context);
    fesetenv(&modes);
    for (int signal = 1; signal < NSIG; ++signal) {
        if (sigismember(before, signal) != sigismember(&after, signal)) {
            CHECK_INT(sigismember(&after, signal), sigismember(before, signal));
        }
    }
}

/* Blocked signals of the thread with the given name, or 0. */
static unsigned long long blocked_signals(const char *thread_name) {
    unsigned long long blocked = 0;
    DIR *tasks = opendir("/proc/self/task");
    for (struct dirent *task; tasks && (task = readdir(tasks));) {
        char path[300], line[256], name[64] = "";
        unsigned long long mask = 0;
        snprintf(path, sizeof path, "/proc/self/task/%s/status", task->d_name);
        FILE *status = fopen(path, "r");
        while (status && fgets(line, sizeof line, status)) {
            sscanf(line, "Name: %63s", name);
            sscanf(line, "SigBlk: %llx", &mask);
        }
        if (status) {
            fclose(status);
        }
        blocked = strcmp(name, thread_name) == 0 ? mask : blocked;
    }
    if (tasks) {
        closedir(tasks);
    }
    return blocked;
}

static bool has_signal(unsigned long long mask, int signal) {
    return (mask >> (signal - 1)) & 1;
}

static void thread_is_named_and_takes_no_signals(void) {
    pnb_context *context = NULL;
    CHECK_RESULT(pnb_context_create(NULL, &context), PNB_OK);
    unsigned long long blocked = blocked_signals("penumbra-gl");
    CHECK(has_signal(blocked, SIGINT) && has_signal(blocked, SIGTERM) && has_signal(blocked, SIGALRM));
    CHECK(has_signal(blocked, SIGCHLD) && has_signal(blocked, SIGPIPE) && has_signal(blocked, SIGUSR1));
    CHECK(!has_signal(blocked, SIGSEGV) && !has_signal(blocked, SIGFPE));
    pnb_context_destroy(&context);
}

static double cpu_seconds(void) {
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + (double)time.tv_nsec * 1e-9;
}

/* CPU time does not depend on what else the machine does: a thread that polls would use some of every interval. */
static void idle_context_sleeps(void) {
    pnb_context *context = NULL;
    CHECK_RESULT(pnb_context_create(NULL, &context), PNB_OK);
    usleep(50 * 1000); /* the driver may still be writing its shader cache */
    double before = cpu_seconds();
    usleep(200 * 1000);
    CHECK_AT_MOST(cpu_seconds() - before, 0.02);
    pnb_context_destroy(&context);
}

int main(void) {
    sigset_t signals;
    pthread_sigmask(SIG_BLOCK, NULL, &signals);
    if (!backend_works(NULL)) {
        printf("skipped: %s\n", pnb_last_error());
        return CHECK_SKIPPED;
    }
    every_backend_opens();
    bad_descriptions_are_refused();
    environment_names_the_backend();
    probe_lists_the_ladder();
    info_checks_its_arguments();
    log_level_is_kept();
    creator_keeps_its_modes(&signals);
    thread_is_named_and_takes_no_signals();
    idle_context_sleeps();
    CHECK_INT(memory_live_blocks(), 0);
    return check_report();
}
