// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/study/report_plots.h"

#include "cli/shell/diagnostics.h"
#include "cli/shell/notes.h"
#include "cli/shell/output_file.h"
#include "session/report/report_plot.h"

#include <errno.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

#define PNG_ZOOM "2" // pixels a unit of the drawing: sharp in print and on dense screens

/// Starts rsvg-convert and waits for it; the PNG goes to `out`. Returns 1: done; 0: it failed; -1:
/// no such program.
static int run_converter(const char *svg, int out) {
    char *const words[] = {"rsvg-convert", "-z", PNG_ZOOM, (char *)svg, NULL};
    posix_spawn_file_actions_t actions;
    pid_t pid;
    int status = 0;
    if (posix_spawn_file_actions_init(&actions) != 0) {
        return 0;
    }
    int error = posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
    error = error ? error : posix_spawnp(&pid, words[0], &actions, NULL, words, environ);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) {
        return error == ENOENT ? -1 : 0;
    }
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {}
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Converts a file to a PNG. Returns as run_converter() does.
static int convert(const char *svg, hn_strbuf *png) {
    char part[4096];
    size_t n;
    FILE *f = tmpfile();
    int converted = f ? run_converter(svg, fileno(f)) : 0;
    if (converted > 0) {
        rewind(f);
        while ((n = fread(part, 1, sizeof part, f)) > 0) {
            hn_strbuf_add_n(png, part, n);
        }
        converted = !ferror(f) && png->n > 0;
    }
    if (f) {
        fclose(f);
    }
    return converted;
}

static hn_exit fail(const hn_args *args, const char *path, const char *why) {
    hn_diag diag = {0};
    hn_diag_set(&diag, HN_ERR_IO, "/plots", NULL, "cannot write '%.200s': %s", path, why);
    return hn_report_diag(args, &diag);
}

/// Writes one plot as SVG, and as PNG while the converter is there.
static hn_exit write_plot(const hn_args *args, const hn_report_plot *plot, int *converts,
                          int *written) {
    char svg[700], png[700];
    hn_strbuf b;
    hn_strbuf_init(&b);

    // a plot without content makes no file
    if (!hn_report_plot_svg(&b, plot)) {
        hn_strbuf_reset(&b);
        return HN_EXIT_DONE;
    }

    // the names of both files
    if (snprintf(svg, sizeof svg, "%s/%s.svg", args->plots, plot->name) >= (int)sizeof svg ||
        snprintf(png, sizeof png, "%s/%s.png", args->plots, plot->name) >= (int)sizeof png) {
        hn_strbuf_reset(&b);
        return fail(args, args->plots, "the name of the folder is too long");
    }

    // the SVG
    const hn_exit done = hn_cli_write_picture(args, svg, &b);
    if (done != HN_EXIT_DONE) {
        return done;
    }
    ++*written;

    // the PNG; if the converter is missing, later plots skip this step
    if (*converts) {
        const int converted = convert(svg, &b);
        if (converted <= 0) {
            hn_strbuf_reset(&b);
        }
        if (converted == 0) {
            return fail(args, png, "rsvg-convert failed");
        }
        *converts = converted > 0;
        return converted > 0 ? hn_cli_write_file(args, png, &b) : HN_EXIT_DONE;
    }
    return HN_EXIT_DONE;
}

hn_exit hn_write_plots(const hn_args *args, const hn_report *r) {
    int converts = 1, written = 0;
    if (mkdir(args->plots, 0777) != 0 && errno != EEXIST) {
        return fail(args, args->plots, strerror(errno));
    }
    for (int i = 0; i < hn_report_n_plots(r); i++) {
        const hn_report_plot plot = hn_report_plot_at(r, i);
        const hn_exit done = write_plot(args, &plot, &converts, &written);
        if (done != HN_EXIT_DONE) {
            return done;
        }
    }
    if (!converts) {
        hn_cli_note("holonom: %d plots were written as SVG; PNG needs rsvg-convert (Debian: "
                    "librsvg2-bin)\n",
                    written);
    }
    return HN_EXIT_DONE;
}
