// SPDX-License-Identifier: GPL-3.0-or-later

#include "dynamics/assembly/assemble_mode.h"

#include "dynamics/assembly/assemble_position.h"
#include "dynamics/assembly/mode.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { TRIES_PER_LOOP = 48, MAX_DEPENDENT = 6, MAX_FOUND = 6, MODE_TEXT = 64 };

typedef struct mode_search {
    hn_assembler *s;
    hn_mode_watch *watch;
    hn_assemble_search *search;
    int n;            ///< loops
    int *asked, *now; ///< per loop +1, -1; 0: either, unknown
    double *values;
    double *start, *best; ///< n of the assembler
    int n_found;
    char found[MAX_FOUND][MODE_TEXT]; ///< modes found, for the report
} mode_search;

static void read_modes(mode_search *m) {
    hn_mode_watch_values(m->watch, m->s->t, m->s->q, m->values);
    for (int k = 0; k < m->n; k++) {
        m->now[k] = hn_mode_sign(m->values[k]);
    }
}

static void write_modes(const mode_search *m, char out[MODE_TEXT]) {
    int n = m->n < MODE_TEXT - 1 ? m->n : MODE_TEXT - 1;
    for (int k = 0; k < n; k++) {
        out[k] = m->now[k] > 0 ? '+' : (m->now[k] < 0 ? '-' : '0');
    }
    out[n] = '\0';
}

static void remember(mode_search *m) {
    char text[MODE_TEXT];
    write_modes(m, text);
    for (int k = 0; k < m->n_found; k++) {
        if (strcmp(m->found[k], text) == 0) {
            return;
        }
    }
    if (m->n_found < MAX_FOUND) {
        memcpy(m->found[m->n_found++], text, sizeof text);
    }
}

/// The first loop that is not as asked for, n when all are. A loop without a mode cannot be wrong.
static int first_wrong(const mode_search *m) {
    int k = 0;
    while (k < m->n && (m->asked[k] == 0 || m->now[k] == 0 || m->now[k] == m->asked[k])) {
        k++;
    }
    return k;
}

static bool is_free(const hn_assembler *s, int user) {
    for (int k = 0; k < s->n_free; k++) {
        if (s->free[k] == user) {
            return true;
        }
    }
    return false;
}

/// Puts the loop's dependent coordinates anywhere: any angle, two reaches either way.
static void scatter(mode_search *m, const int *dependent, int n, uint64_t *seed) {
    hn_assembler *s = m->s;
    for (int k = 0; k < n; k++) {
        const int i = dependent[k];
        const double spread = s->reach[i] == 1 ? M_PI : 2 * s->reach[i];
        const double by = spread * hn_assemble_random(seed);
        if (is_free(s, i)) {
            s->x[i] += by;
        }
    }
}

/// Angles back to within half a turn of where they began; whole turns change no pose.
static void unwind(const mode_search *m) {
    hn_assembler *s = m->s;
    for (int i = 0; i < s->n; i++) {
        const hn_coordinate *c = &s->scene->coordinates[hn_system_user_coordinate(s->sys, i)];
        if (c->kind == HN_ANGLE && s->turn[i] < 0 && !s->scene->is_lagrangian) {
            s->x[i] -= 2 * M_PI * round((s->x[i] - s->guess[i]) / (2 * M_PI));
        }
    }
}

/// Closes loop `wrong` in the mode asked for, without changing the mode of those before it.
/// *corrected = 1 when it found such a pose.
static hn_status correct_loop(mode_search *m, int wrong, int *corrected) {
    hn_assembler *s = m->s;
    int dependent[MAX_DEPENDENT], n = 0;
    uint64_t seed = 100 + (uint64_t)wrong;
    *corrected = 0;

    // the loop's dependent coordinates anywhere, all others as they are
    HN_TRY(hn_mode_dependent(s->sys, s->arena, wrong, dependent, &n));
    memcpy(m->start, s->x, (size_t)s->n * sizeof *s->x);

    for (int k = 0; k < TRIES_PER_LOOP; k++) {
        memcpy(s->x, m->start, (size_t)s->n * sizeof *s->x);
        scatter(m, dependent, n, &seed);
        if (!hn_assemble_descend(m->search)) {
            continue;
        }
        read_modes(m);
        remember(m);
        if (first_wrong(m) > wrong) {
            *corrected = 1;
            break;
        }
    }
    return HN_OK;
}

static hn_status report_missing(const mode_search *m) {
    char list[MAX_FOUND * (MODE_TEXT + 4)] = "";
    size_t used = 0;
    for (int k = 0; k < m->n_found && used < sizeof list; k++) {
        const int wrote =
            snprintf(list + used, sizeof list - used, "%s'%s'", k ? ", " : "", m->found[k]);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    return hn_diags_add(
        m->s->diags, HN_ERR_UNREACHABLE, "/start/mode",
        "ask for one of these, give a start value as 'guess', or start nearer to the wanted mode",
        "the assembly mode '%s' was not found with the start values that are kept; found: %s",
        m->s->scene->mode, list);
}

/// "open" and "crossed" are + and -; else one sign per loop.
static hn_status read_asked(mode_search *m) {
    const char *mode = m->s->scene->mode;
    if (strcmp(mode, "open") == 0 || strcmp(mode, "crossed") == 0) {
        if (m->n > 0) {
            m->asked[0] = mode[0] == 'o' ? 1 : -1;
        }
        return HN_OK;
    }
    const int n = (int)strlen(mode);
    if (n > m->n) {
        return hn_diags_add(m->s->diags, HN_ERR_INPUT, "/start/mode", "one sign per loop",
                            "the assembly mode '%s' has %d signs, the scene has %d loop%s", mode, n,
                            m->n, m->n == 1 ? "" : "s");
    }
    for (int k = 0; k < n; k++) {
        m->asked[k] = mode[k] == '+' ? 1 : -1;
    }
    return HN_OK;
}

static hn_status search_modes(mode_search *m) {
    hn_assembler *s = m->s;
    hn_status status = read_asked(m);
    read_modes(m);
    remember(m);

    int wrong = first_wrong(m);
    if (status != HN_OK || wrong == m->n) {
        return status;
    }

    // loop by loop, in their order
    memcpy(m->best, s->x, (size_t)s->n * sizeof *s->x);
    status = hn_assemble_search_create(s, &m->search);
    while (status == HN_OK && wrong < m->n) {
        int corrected;
        status = correct_loop(m, wrong, &corrected);
        if (status == HN_OK && !corrected) {
            status = report_missing(m);
        }
        wrong = corrected ? first_wrong(m) : wrong;
    }

    // on failure back to the pose that was closed
    if (status == HN_OK) {
        unwind(m);
        s->route = "mode search";
    } else {
        memcpy(s->x, m->best, (size_t)s->n * sizeof *s->x);
    }
    (void)hn_assemble_evaluate(s);
    return status;
}

hn_status hn_assemble_mode(hn_assembler *s) {
    if (!s->scene->mode) {
        return HN_OK;
    }
    mode_search m = {.s = s};
    hn_status status = hn_mode_watch_create(s->sys, s->arena, &m.watch);
    if (status != HN_OK) {
        return status;
    }
    m.n = hn_mode_watch_count(m.watch);
    m.asked = hn_arena_ints(s->arena, (size_t)m.n + 1);
    m.now = hn_arena_ints(s->arena, (size_t)m.n + 1);
    m.values = hn_arena_doubles(s->arena, (size_t)m.n + 1);
    m.start = hn_arena_doubles(s->arena, (size_t)s->n);
    m.best = hn_arena_doubles(s->arena, (size_t)s->n);
    status = hn_arena_failed(s->arena) ? HN_ERR_MEMORY : search_modes(&m);
    hn_mode_watch_free(m.watch);
    return status;
}
