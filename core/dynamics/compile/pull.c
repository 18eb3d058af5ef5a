// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/compile/pull.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct entry {
    double t;
    hn_pull pull;
    int place; ///< of its point among the points of the log
} entry;

struct hn_pull_log {
    int *points;
    int n_points, n, cap;
    entry *entries; ///< by time
    double stop;
};

hn_pull_log *hn_pull_log_create(const int *points, int n_points) {
    hn_pull_log *log = calloc(1, sizeof *log);
    int *copy = malloc(((size_t)n_points + 1) * sizeof *copy);
    if (!log || !copy) {
        free(log);
        free(copy);
        return NULL;
    }
    memcpy(copy, points, (size_t)n_points * sizeof *copy);
    *log = (hn_pull_log){.points = copy, .n_points = n_points, .stop = HUGE_VAL};
    return log;
}

void hn_pull_log_free(hn_pull_log *log) {
    if (log) {
        free(log->points);
        free(log->entries);
        free(log);
    }
}

int hn_pull_log_find(const hn_pull_log *log, int point) {
    for (int i = 0; i < log->n_points; i++) {
        if (log->points[i] == point) {
            return i;
        }
    }
    return -1;
}

static hn_status make_room(hn_pull_log *log) {
    if (log->n < log->cap) {
        return HN_OK;
    }
    if (log->n >= HN_PULL_MOST_ENTRIES) {
        return HN_ERR_LIMIT;
    }
    const int cap = log->cap ? 2 * log->cap : 64;
    entry *grown = realloc(log->entries, (size_t)cap * sizeof *grown);
    if (!grown) {
        return HN_ERR_MEMORY;
    }
    log->entries = grown;
    log->cap = cap;
    return HN_OK;
}

hn_status hn_pull_log_add(hn_pull_log *log, double t, const hn_pull *pull) {
    const int place = hn_pull_log_find(log, pull->point);
    if (place < 0) {
        return HN_ERR_INPUT;
    }

    // two entries of one time: the later one counts
    const double last = log->n > 0 ? log->entries[log->n - 1].t : -HUGE_VAL;
    if (t <= last) {
        log->entries[log->n - 1] = (entry){last, *pull, place};
        return HN_OK;
    }
    HN_TRY(make_room(log));
    log->entries[log->n++] = (entry){t, *pull, place};
    return HN_OK;
}

void hn_pull_log_clear(hn_pull_log *log) {
    log->n = 0;
    log->stop = HUGE_VAL;
}

void hn_pull_log_set_stop(hn_pull_log *log, double t) {
    log->stop = t;
}

/// Returns how many entries have begun by t. Runs are near the end of the log: the search begins
/// there.
static int count_begun(const hn_pull_log *log, double t) {
    int n = log->n;
    while (n > 0 && log->entries[n - 1].t > t) {
        n--;
    }
    return n;
}

double hn_pull_log_next_corner(const hn_pull_log *log, double t) {
    const int n = count_begun(log, t);
    if (n < log->n) {
        return log->entries[n].t;
    }
    return log->stop > t ? log->stop : HUGE_VAL;
}

static const entry *entry_at(const hn_pull_log *log, double t) {
    const int n = count_begun(log, t);
    const entry *e = n > 0 ? &log->entries[n - 1] : NULL;
    return e && (e->pull.stiffness > 0 || e->pull.damping > 0) ? e : NULL;
}

const hn_pull *hn_pull_log_at(const hn_pull_log *log, double t) {
    const entry *e = entry_at(log, t);
    return e ? &e->pull : NULL;
}

void hn_pull_log_put(const hn_pull_log *log, double t, double *inputs) {
    const entry *e = entry_at(log, t);
    memset(inputs, 0, (size_t)(HN_PULL_INPUTS * log->n_points) * sizeof *inputs);
    if (e) {
        double *of = inputs + (size_t)HN_PULL_INPUTS * (size_t)e->place;
        of[0] = e->pull.stiffness;
        of[1] = e->pull.damping;
        memcpy(of + 2, e->pull.to, sizeof e->pull.to);
    }
}
