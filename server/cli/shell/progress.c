// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/progress.h"

#include "base/clock.h"

#include <stdio.h>
#include <unistd.h>

/// As a person would say it.
static void put_left(double seconds) {
    if (seconds < 90) {
        fprintf(stderr, ", %.0f s left", seconds);
    } else if (seconds < 90 * 60) {
        fprintf(stderr, ", %.0f min left", seconds / 60);
    } else {
        fprintf(stderr, ", %.1f h left", seconds / 3600);
    }
}

/// Writes what is done, and how long the rest will take if it goes on like this.
static void put_bar(const char *what, double share, double risen, double elapsed) {
    enum { WIDTH = 24 };
    const int done = (int)(WIDTH * (share < 0 ? 0 : share > 1 ? 1 : share));
    fprintf(stderr, "\r\033[K%s [%.*s%.*s] %3.0f %%", what, done, "########################",
            WIDTH - done, "........................", 100 * share);
    if (risen > 0.01) {
        put_left(elapsed * (1 - share) / risen);
    }
}

void hn_progress_tell(hn_progress *p, const char *what, double share) {
    static const double PATIENCE = 1, BETWEEN = 0.1; // [s]
    double t = hn_clock_wall();
    if (p->started == 0) {
        p->started = t;
    }
    if (p->begun == 0 || share <= p->first) {
        p->begun = t;
        p->first = share;
    }
    if (t - p->started < PATIENCE || t - p->last < BETWEEN || !isatty(STDERR_FILENO)) {
        return;
    }
    put_bar(what, share, share - p->first, t - p->begun);
    fflush(stderr);
    p->last = t;
    p->shown = 1;
}

void hn_progress_end(hn_progress *p) {
    if (p->shown) {
        fputs("\r\033[K", stderr);
        p->shown = 0;
    }
}
