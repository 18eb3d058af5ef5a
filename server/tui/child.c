// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

enum { MOST_ARGUMENTS = 64, CHUNK = 4096 };
static const size_t MOST_TEXT = 4u << 20; // [bytes] of one study's text

/// The environment with COLUMNS in front, where the first entry of a name counts. Owned; NULL: no
/// memory.
static char **environment_of(char *columns) {
    size_t n = 0;
    while (environ[n]) {
        n++;
    }
    char **copy = calloc(n + 2, sizeof *copy);
    for (size_t i = 0, used = 1; copy && i < n; i++) {
        if (strncmp(environ[i], "COLUMNS=", 8) != 0) {
            copy[used++] = environ[i];
        }
    }
    if (copy) {
        copy[0] = columns;
    }
    return copy;
}

bool hn_child_start(hn_child *child, const char *const *arguments, int columns) {
    char width[32];
    snprintf(width, sizeof width, "COLUMNS=%d", columns);
    char **environment = environment_of(width);
    char *argv[MOST_ARGUMENTS + 2] = {"holonom"};
    int pipe_ends[2], n = 1;
    while (*arguments && n <= MOST_ARGUMENTS) {
        argv[n++] = (char *)(size_t)*arguments++;
    }
    if (!environment || pipe(pipe_ends) != 0) {
        free(environment);
        return false;
    }
    fcntl(pipe_ends[0], F_SETFD, FD_CLOEXEC);
    fcntl(pipe_ends[1], F_SETFD, FD_CLOEXEC);

    // standard output and errors into the pipe, no input, a group of its own so that all of it can
    // be stopped
    posix_spawn_file_actions_t actions;
    posix_spawnattr_t attributes;
    posix_spawn_file_actions_init(&actions);
    posix_spawnattr_init(&attributes);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], 1);
    posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], 2);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int failed =
        posix_spawn(&child->pid, "/proc/self/exe", &actions, &attributes, argv, environment);
    free(environment);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    close(pipe_ends[1]);
    if (failed) {
        close(pipe_ends[0]);
        child->pid = 0;
        return false;
    }
    child->output = pipe_ends[0];
    fcntl(child->output, F_SETFL, O_NONBLOCK);
    return true;
}

static void forget(hn_child *child) {
    int status = -1;
    close(child->output);
    waitpid(child->pid, &status, 0);
    child->status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    child->pid = 0;
}

bool hn_child_read(hn_child *child, hn_strbuf *text) {
    char chunk[CHUNK];
    if (child->pid == 0) {
        return false;
    }
    for (;;) {
        const ssize_t n = read(child->output, chunk, sizeof chunk);
        if (n > 0 && text->n + (size_t)n < MOST_TEXT) {
            hn_strbuf_add_n(text, chunk, (size_t)n);
        } else if (n == 0) {
            forget(child);
            return false;
        } else if (n < 0) {
            return true;
        }
    }
}

void hn_child_stop(hn_child *child) {
    if (child->pid != 0) {
        kill(-child->pid, SIGTERM);
        // a study that saves what it has done gets a moment for it
        for (int i = 0; i < 20 && waitpid(child->pid, NULL, WNOHANG) == 0; i++) {
            poll(NULL, 0, 50);
        }
        kill(-child->pid, SIGKILL);
        close(child->output);
        waitpid(child->pid, NULL, 0);
        child->pid = 0;
    }
}
