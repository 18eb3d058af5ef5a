// SPDX-License-Identifier: GPL-3.0-or-later

#include "dynamics/assembly/assemble.h"

#include "dynamics/assembly/assemble_explain.h"
#include "dynamics/assembly/assemble_mode.h"
#include "dynamics/assembly/assemble_pose.h"
#include "dynamics/assembly/assemble_position.h"
#include "dynamics/assembly/mode.h"
#include "dynamics/compile/coordinates.h"
#include "dynamics/evaluate/accel.h"
#include "linalg/dense.h"
#include "linalg/qr.h"
#include "linalg/saddle.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// a velocity gap below this times |J| |v| + |phi_t| is rounding
static const double VELOCITY_ROUNDING = 4 * DBL_EPSILON;
// rank of J D for the report, as in linalg/saddle.h
static const double RANK_TOL = 1e-10;

static const hn_coordinate *user_coordinate(const hn_assembler *s, int i) {
    return &s->scene->coordinates[hn_system_user_coordinate(s->sys, i)];
}

// ---- setting up ----

/// A pin or a guess on a joint that closes a loop has no coordinate to hold or to begin from, so it
/// is refused.
static hn_status check_pins(const hn_assembler *s) {
    hn_status status = HN_OK;
    for (int i = 0; i < s->scene->n_coordinates; i++) {
        const hn_coordinate *c = &s->scene->coordinates[i];
        if (c->joint < 0 || !hn_system_joint_is_cut(s->sys, c->joint)) {
            continue;
        }
        if (c->q0_given || c->v0_given) {
            const int pinned = c->q0_pinned || c->v0_pinned;
            status = hn_diags_add(
                s->diags, HN_ERR_UNSUPPORTED, c->q0_given ? c->q0_pointer : c->v0_pointer,
                pinned ? "pin another coordinate, or say \"cut\": true at another joint of the loop"
                       : "guess another one, or say \"cut\": true at another joint of the loop",
                "%s cannot be %s: its joint closes a loop and follows from the others", c->name,
                pinned ? "pinned" : "guessed");
        }
    }
    return status;
}

/// An orientation is pinned as a whole: one entry of its rotation vector alone cannot be held.
static hn_status check_orientations(const hn_assembler *s) {
    for (int i = 0; i + 2 < s->n; i++) {
        const hn_coordinate *c = user_coordinate(s, i);
        if (s->turn[i] == 0 &&
            (c[0].q0_pinned != c[1].q0_pinned || c[1].q0_pinned != c[2].q0_pinned)) {
            const hn_coordinate *pinned = &c[c[0].q0_pinned ? 0 : c[1].q0_pinned ? 1 : 2];
            return hn_diags_add(s->diags, HN_ERR_INPUT, pinned->q0_pointer,
                                "pin all three entries, or none and give them as a guess",
                                "%s, %s and %s are one orientation: %s alone cannot be pinned",
                                c[0].name, c[1].name, c[2].name, pinned->name);
        }
    }
    return HN_OK;
}

/// T^-1 column by column, nonzeros only.
static hn_status read_map(hn_assembler *s) {
    int n = s->n, count = 0;
    double *user = hn_arena_doubles(s->arena, (size_t)n),
           *rates = hn_arena_doubles(s->arena, (size_t)n);
    s->map_start = hn_arena_ints(s->arena, (size_t)n + 1);
    if (!user || !rates || !s->map_start) {
        return HN_ERR_MEMORY;
    }

    // count the entries, then store them
    for (int pass = 0; pass < 2; pass++) {
        if (pass == 1) {
            s->map_row = hn_arena_ints(s->arena, (size_t)count);
            s->map_value = hn_arena_doubles(s->arena, (size_t)count);
            if (!s->map_row || !s->map_value) {
                return HN_ERR_MEMORY;
            }
            count = 0;
        }

        // column k: the rates of a unit rate of user coordinate k
        for (int k = 0; k < n; k++) {
            user[k] = 1;
            hn_system_rates_from_user(s->sys, user, rates);
            user[k] = 0;
            s->map_start[k] = count;
            for (int i = 0; i < n; i++) {
                if (rates[i] == 0) {
                    continue;
                }
                if (pass == 1) {
                    s->map_row[count] = i;
                    s->map_value[count] = rates[i];
                }
                count++;
            }
        }

        s->map_start[n] = count;
    }
    return HN_OK;
}

static hn_status start(hn_assembler *s) {
    size_t n = (size_t)s->n, nc = (size_t)s->nc;
    s->x = hn_arena_doubles(s->arena, n);
    s->guess = hn_arena_doubles(s->arena, n);
    s->q = hn_arena_doubles(s->arena, (size_t)s->nq);
    s->turn = hn_arena_ints(s->arena, n);
    s->rest = hn_arena_doubles(s->arena, n);
    s->reach = hn_arena_doubles(s->arena, n);
    s->free = hn_arena_ints(s->arena, n);
    s->row_scale = hn_arena_doubles(s->arena, nc);
    s->residual = hn_arena_doubles(s->arena, nc);
    if (hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }

    // start values, and which coordinates may move
    for (int i = 0, at = 0; i < s->n; i++) {
        const hn_coordinate *c = user_coordinate(s, i);
        s->turn[i] = hn_system_position_of(s->sys, i) < 0 ? at++ % 3 : -1;
        s->x[i] = s->guess[i] = c->q0;
        s->reach[i] = c->kind == HN_LENGTH ? s->length : 1;
        if (!c->q0_pinned) {
            s->free[s->n_free++] = i;
        }
    }

    // what the stages need
    for (int i = 0; i < s->nc; i++) {
        s->row_scale[i] = 1 / hn_system_row_unit(s->sys, i);
    }
    HN_TRY(check_orientations(s));
    HN_TRY(read_map(s));
    unsigned terms = HN_TERM_M | HN_TERM_PHI | HN_TERM_PHI_T | HN_TERM_J | HN_TERM_ENERGY;
    return hn_eval_create(s->sys, terms, s->arena, &s->eval);
}

// ---- pose ----

static int find_worst_loop(const hn_assembler *s) {
    int worst = -1;
    double largest = -1;
    for (int i = 0; i < s->nc; i++) {
        int loop = hn_system_row_loop(s->sys, i);
        double gap = hn_assemble_gap(s, loop);
        if (gap > largest) {
            largest = gap;
            worst = loop;
        }
    }
    return worst;
}

static hn_status find_pose(hn_assembler *s, hn_assembly *report) {
    int finite = hn_assemble_evaluate(s);
    report->gap_before = hn_assemble_gap(s, -1);
    hn_status status = finite ? hn_assemble_position(s) : HN_ERR_DIVERGED;

    // the pose, then the assembly mode that the scene asks for
    const int closed = status == HN_OK;
    if (closed) {
        status = hn_assemble_mode(s);
    }

    report->gap = hn_assemble_gap(s, -1);
    report->iterations = s->iterations;
    report->route = s->route;
    for (int i = 0; i < s->n; i++) {
        report->moved = fmax(report->moved, hn_assemble_moved(s, i));
    }

    // say why there is none
    if (status == HN_ERR_UNREACHABLE && !closed) {
        const int flipped = hn_assemble_flipped(s);
        report->worst_loop = flipped >= 0 ? flipped : find_worst_loop(s);
        hn_assemble_explain(s, report->worst_loop);
    } else if (status == HN_ERR_DIVERGED) {
        hn_diags_add(s->diags, status, NULL, NULL,
                     "the closure equations have no finite value at the start values");
    }
    return status;
}

// ---- velocities ----

/// gap = J v + phi_t, and whether it is more than rounding.
static int velocity_gap(const hn_assembler *s, const double *v, double *gap) {
    const double *J = hn_eval_get(s->eval, HN_TERM_J), *phi_t = hn_eval_get(s->eval, HN_TERM_PHI_T);
    int open = 0;
    for (int i = 0; i < s->nc; i++) {
        double size = fabs(phi_t[i]);
        gap[i] = phi_t[i];
        for (int k = 0; k < s->n; k++) {
            double part = J[(size_t)i * s->n + k] * v[k];
            gap[i] += part;
            size += fabs(part);
        }
        open |= fabs(gap[i]) > VELOCITY_ROUNDING * size;
    }
    return open;
}

/// x' M y for two columns of T^-1, so that M in user rates costs only what is not zero.
static double user_mass(const hn_assembler *s, int k, int l) {
    const double *M = hn_eval_get(s->eval, HN_TERM_M);
    double sum = 0;
    for (int e = s->map_start[k]; e < s->map_start[k + 1]; e++) {
        for (int d = s->map_start[l]; d < s->map_start[l + 1]; d++) {
            sum +=
                s->map_value[e] * M[(size_t)s->map_row[e] * s->n + s->map_row[d]] * s->map_value[d];
        }
    }
    return sum;
}

/// The least change of the free rates that closes J v + phi_t: J (nc x n_free), weight
/// (n_free x n_free).
typedef struct rate_problem {
    int n_free, *free;
    double *J, *weight, *force, *change, *gap;
    hn_saddle_ws *ws;
} rate_problem;

static hn_status rate_problem_init(rate_problem *p, hn_assembler *s) {
    *p = (rate_problem){.free = hn_arena_ints(s->arena, (size_t)s->n)};
    if (!p->free) {
        return HN_ERR_MEMORY;
    }

    // rates that may change
    for (int i = 0; i < s->n; i++) {
        if (!user_coordinate(s, i)->v0_pinned) {
            p->free[p->n_free++] = i;
        }
    }

    size_t n = (size_t)p->n_free, nc = (size_t)s->nc;
    p->J = hn_arena_doubles(s->arena, nc * n);
    p->weight = hn_arena_doubles(s->arena, n * n);
    p->force = hn_arena_doubles(s->arena, n);
    p->change = hn_arena_doubles(s->arena, n);
    p->gap = hn_arena_doubles(s->arena, nc);
    p->ws = hn_saddle_ws_create(s->arena, p->n_free, s->nc);
    double *row = hn_arena_doubles(s->arena, (size_t)s->n);
    if (!p->ws || !row || hn_arena_failed(s->arena)) {
        return HN_ERR_MEMORY;
    }

    // rows of J in these rates
    for (int i = 0; i < s->nc; i++) {
        hn_assemble_user_row(s, i, row);
        for (int k = 0; k < p->n_free; k++) {
            p->J[(size_t)i * p->n_free + k] = row[p->free[k]];
        }
    }
    return HN_OK;
}

/// Weight of least change: the mass matrix, or the plain sizes of the coordinates where mass alone
/// decides nothing.
static void fill_weight(const hn_assembler *s, rate_problem *p, int by_mass) {
    int n = p->n_free;
    for (int k = 0; k < n; k++) {
        for (int l = 0; l <= k; l++) {
            double reach = s->reach[p->free[k]];
            double w =
                by_mass ? user_mass(s, p->free[k], p->free[l]) : (k == l ? 1 / (reach * reach) : 0);
            p->weight[(size_t)k * n + l] = w;
        }
    }
}

static hn_status factor_rates(const hn_assembler *s, rate_problem *p) {
    fill_weight(s, p, 1);
    hn_status status = hn_saddle_factor(p->n_free, s->nc, p->weight, p->J, NULL, NULL, p->ws);
    if (status == HN_ERR_SINGULAR || status == HN_ERR_NOT_SPD) {
        fill_weight(s, p, 0);
        status = hn_saddle_factor(p->n_free, s->nc, p->weight, p->J, NULL, NULL, p->ws);
    }
    return status;
}

/// "w1, w3" into text: the rates that are held.
static void list_pinned_rates(const hn_assembler *s, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i < s->n && used + 1 < size; i++) {
        const hn_coordinate *c = user_coordinate(s, i);
        if (c->v0_pinned) {
            int wrote =
                snprintf(text + used, size - used, "%s%s = %.6g", used ? ", " : "", c->rate, c->v0);
            used += wrote > 0 ? (size_t)wrote : 0;
        }
    }
}

static hn_status report_contradiction(hn_assembler *s, const double *gap) {
    char pinned[160];
    list_pinned_rates(s, pinned, sizeof pinned);
    const char *pointer = NULL;
    for (int i = 0; i < s->n; i++) {
        pointer = user_coordinate(s, i)->v0_pinned ? user_coordinate(s, i)->v0_pointer : pointer;
    }
    return hn_diags_add(
        s->diags, HN_ERR_INCONSISTENT, pointer, "let one of these rates be free",
        "the pinned rates %s contradict the closed loops: |J v| = %.3g is left whatever the other "
        "rates are",
        pinned[0] ? pinned : "(none)", hn_norm2(s->nc, gap));
}

/// Changes the free user rates least so that J v + phi_t = 0; v (n) in system rates, in and out.
static hn_status correct_rates(hn_assembler *s, double *user_v, double *v, rate_problem *p) {
    // the second round takes what rounding left of the first
    for (int round = 0; round < 2; round++) {
        hn_status status = hn_saddle_apply(p->force, p->gap, p->change, NULL, NULL, p->ws);
        if (status == HN_ERR_INCONSISTENT) {
            return round == 0 ? report_contradiction(s, p->gap) : HN_OK;
        }
        if (status != HN_OK) {
            return status;
        }
        for (int k = 0; k < p->n_free; k++) {
            user_v[p->free[k]] += p->change[k];
        }
        hn_system_rates_from_user(s->sys, user_v, v);
        if (!velocity_gap(s, v, p->gap)) {
            break;
        }
    }
    return HN_OK;
}

static hn_status find_rates(hn_assembler *s, double *v, hn_assembly *report) {
    double *user_v = hn_arena_doubles(s->arena, (size_t)s->n),
           *gap = hn_arena_doubles(s->arena, (size_t)s->nc);
    if (!user_v || !gap) {
        return HN_ERR_MEMORY;
    }

    // the rates asked for, and how far they open the loops
    for (int i = 0; i < s->n; i++) {
        user_v[i] = user_coordinate(s, i)->v0;
    }
    hn_system_rates_from_user(s->sys, user_v, v);
    hn_eval_run(s->eval, s->t, s->q, v);
    int open = velocity_gap(s, v, gap);
    report->velocity_gap_before = report->velocity_gap = hn_norm2(s->nc, gap);
    if (!open) {
        return HN_OK;
    }

    // the smallest change that closes them
    rate_problem p;
    HN_TRY(rate_problem_init(&p, s));
    memcpy(p.gap, gap, (size_t)s->nc * sizeof *gap);
    HN_TRY(factor_rates(s, &p));
    const hn_status status = correct_rates(s, user_v, v, &p);

    (void)velocity_gap(s, v, gap);
    report->velocity_gap = hn_norm2(s->nc, gap);
    return status;
}

// ---- accelerations and the report ----

static hn_status find_accelerations(hn_assembler *s, const double *v, double *a, double *lambda) {
    hn_accel *accel = NULL;
    hn_accel_opts opts = {.want_lambda = 1};
    hn_status status = hn_accel_create(s->sys, &opts, s->arena, &accel);
    double *a_out = hn_arena_doubles(s->arena, (size_t)s->n),
           *l_out = hn_arena_doubles(s->arena, (size_t)s->nc);

    if (status == HN_OK && (!a_out || !l_out)) {
        status = HN_ERR_MEMORY;
    }

    // solve, and say so where that fails
    if (status == HN_OK) {
        hn_accel_info info;
        status = hn_accel_eval(accel, s->t, s->q, v, 0, 0, a_out, l_out, &info);
        if (status != HN_OK) {
            hn_diags_add(s->diags, status, NULL, NULL,
                         "the accelerations at the start are not determined: %s",
                         hn_status_text(status));
        }
    }

    // outputs stay untouched on failure
    if (status == HN_OK && a) {
        memcpy(a, a_out, (size_t)s->n * sizeof *a);
    }
    if (status == HN_OK && lambda) {
        memcpy(lambda, l_out, (size_t)s->nc * sizeof *lambda);
    }
    hn_accel_free(accel);
    return status;
}

/// Rank and singular values of J D with D = diag(M)^-1/2: independent of the units of the
/// coordinates.
static hn_status report_rank(hn_assembler *s, hn_assembly *report) {
    int n = s->n;
    hn_qr qr;
    double *d = hn_arena_doubles(s->arena, (size_t)n);
    if (!hn_qr_init(&qr, s->arena, n, s->nc) || !d) {
        return HN_ERR_MEMORY;
    }

    // J D with D = diag(M)^-1/2; massless velocities count as the heaviest
    const double *M = hn_eval_get(s->eval, HN_TERM_M), *J = hn_eval_get(s->eval, HN_TERM_J);
    double heaviest = 0;
    for (int k = 0; k < n; k++) {
        heaviest = fmax(heaviest, M[(size_t)k * n + k]);
    }
    for (int k = 0; k < n; k++) {
        double m = M[(size_t)k * n + k];
        d[k] = 1 / sqrt(m > 1e-14 * heaviest ? m : (heaviest > 0 ? heaviest : 1));
    }
    for (int i = 0; i < s->nc; i++) {
        for (int k = 0; k < n; k++) {
            qr.a[(size_t)i * n + k] = J[(size_t)i * n + k] * d[k];
        }
    }

    // rank and singular values
    hn_qr_factor(&qr, n, s->nc, RANK_TOL);
    hn_qr_sigma(&qr, &report->sigma_min, &report->sigma_max);
    report->rank = qr.rank;
    report->freedoms = n - qr.rank;
    report->redundant = s->nc - qr.rank;
    return HN_OK;
}

static hn_status report_mode(hn_assembler *s, hn_assembly *report) {
    hn_mode_watch *watch = NULL;
    int four_bar = 0;
    hn_status status = hn_mode_watch_create(s->sys, s->arena, &watch);
    if (status != HN_OK) {
        return status;
    }

    // the sign of every loop
    const int n = hn_mode_watch_count(watch);
    double *values = hn_arena_doubles(s->arena, (size_t)n + 1);
    if (values) {
        hn_mode_watch_values(watch, s->t, s->q, values);
        report->mode = hn_mode_sign(values[0]);
    }
    for (int k = 0; values && k < n && k < (int)sizeof report->modes - 1; k++) {
        const int sign = hn_mode_sign(values[k]);
        report->modes[k] = sign > 0 ? '+' : (sign < 0 ? '-' : '0');
    }

    hn_mode_watch_free(watch);
    if (!values) {
        return HN_ERR_MEMORY;
    }

    // a four-bar's modes have names
    status = hn_mode_is_four_bar(s->sys, s->arena, &four_bar);
    if (report->mode != 0) {
        const char *positive = four_bar ? "open" : "+", *negative = four_bar ? "crossed" : "-";
        report->mode_name = report->mode > 0 ? positive : negative;
    }
    return status;
}

static hn_status fill_report(hn_assembler *s, hn_assembly *report) {
    const double *energy = hn_eval_get(s->eval, HN_TERM_ENERGY);
    report->energy = energy[0] + energy[1];
    HN_TRY(report_mode(s, report));
    return report_rank(s, report);
}

static hn_status run_stages(hn_assembler *s, double *q, double *v, double *a, double *lambda,
                            hn_assembly *report) {
    memset(q, 0, (size_t)s->nq * sizeof *q);
    memset(v, 0, (size_t)s->n * sizeof *v);

    // what holds before anything moves
    HN_TRY(check_pins(s));
    HN_TRY(start(s));

    // pose, velocities, accelerations
    hn_status status = find_pose(s, report);
    memcpy(q, s->q, (size_t)s->nq * sizeof *q);
    HN_THEN(status, find_rates(s, v, report));
    if (status == HN_OK && (a || lambda)) {
        status = find_accelerations(s, v, a, lambda);
    }

    // the report, also of what was reached on failure
    hn_eval_run(s->eval, s->t, s->q, v);
    const hn_status reported = fill_report(s, report);
    return status != HN_OK ? status : reported;
}

hn_status hn_assemble(const hn_system *sys, double t, double *q, double *v, double *a,
                      double *lambda, hn_assembly *report, hn_diags *diags) {
    hn_system_info info = hn_system_get_info(sys);
    HN_ASSERT(info.n_user == info.nv);
    hn_assembly local;

    // what is reported when nothing was reached
    report = report ? report : &local;
    *report = (hn_assembly){.worst_loop = -1, .mode_name = "none", .route = "already closed"};

    hn_assembler s = {.sys = sys,
                      .scene = hn_system_scene(sys),
                      .arena = hn_arena_create(0),
                      .diags = diags,
                      .t = t,
                      .n = info.nv,
                      .nq = info.nq,
                      .nc = info.nc,
                      .length = hn_system_length(sys),
                      .route = "already closed"};

    if (!s.arena) {
        return HN_ERR_MEMORY;
    }
    hn_status status = run_stages(&s, q, v, a, lambda, report);
    report->ok = status == HN_OK;
    hn_eval_free(s.eval);
    hn_arena_free(s.arena);
    return status;
}
