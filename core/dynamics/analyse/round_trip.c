// SPDX-License-Identifier: GPL-3.0-or-later
#include "dynamics/analyse/round_trip.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

// of a radian, or of the characteristic length: coordinates this near are back. sigma_min differs
// there by a few thousandths of its largest, less than what counts as singular
static const double BACK = 1e-3;
// of the lowest sigma_min on the way: a lower one is not on this curve
static const double BELOW = 0.9;
enum { HALVINGS = 40 };

/// A state on the way.
typedef struct place {
    double t, *q, *v;
} place;

struct hn_round_trip {
    bool serves;  ///< plain coordinates, and no time in the equations
    int n;        ///< coordinates
    bool *turns;  ///< n: an angle
    double *unit; ///< n: the characteristic length for lengths, else 1
    bool begun, closed;
    place start, last;
    double sigma_start;
    double lowest, lowest_round; ///< sigma_min since the start; along the closed way
    int rounds;                  ///< full turns of the joint that has turned furthest
    double *there;               ///< n: where the way closes
};

// ---- life ----

hn_status hn_round_trip_create(const hn_system *sys, hn_arena *arena, hn_round_trip **out) {
    const hn_system_info info = hn_system_get_info(sys);
    const size_t n = (size_t)info.nv;
    hn_round_trip *r = hn_arena_get(arena, sizeof *r);
    *out = NULL;
    if (!r) {
        return HN_ERR_MEMORY;
    }
    *r = (hn_round_trip){.serves = info.nq == info.nv && !info.has_time, .n = info.nv};
    r->turns = hn_arena_get(arena, (n + 1) * sizeof *r->turns);
    double **const arrays[] = {&r->unit,   &r->start.q, &r->start.v,
                               &r->last.q, &r->last.v,  &r->there};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        *arrays[i] = hn_arena_doubles(arena, n);
    }
    if (hn_arena_failed(arena)) {
        return HN_ERR_MEMORY;
    }

    for (int i = 0; i < r->n; i++) {
        const int user = hn_system_user_coordinate(sys, i);
        const hn_unit_kind kind = hn_system_scene(sys)->coordinates[user].kind;
        r->turns[i] = kind == HN_ANGLE;
        r->unit[i] = kind == HN_LENGTH ? hn_system_length(sys) : 1;
    }
    *out = r;
    return HN_OK;
}

void hn_round_trip_reset(hn_round_trip *r) {
    r->begun = r->closed = false;
    r->lowest_round = 0;
    r->rounds = 0;
}

void hn_round_trip_reject(hn_round_trip *r) {
    hn_round_trip_reset(r);
}

double hn_round_trip_lowest(const hn_round_trip *r) {
    return r->closed ? r->lowest_round : 0;
}

// ---- the way ----

static void put(const hn_round_trip *r, place *p, double t, const double *q, const double *v) {
    p->t = t;
    memcpy(p->q, q, (size_t)r->n * sizeof *q);
    memcpy(p->v, v, (size_t)r->n * sizeof *v);
}

static void begin(hn_round_trip *r, double t, const double *q, const double *v, double sigma) {
    hn_round_trip_reset(r);
    put(r, &r->start, t, q, v);
    put(r, &r->last, t, q, v);
    r->lowest = r->sigma_start = sigma;
    r->begun = true;
}

/// The joint that has turned round once more than any has before, or -1.
static int find_turned(const hn_round_trip *r, const double *q) {
    const double turn = 2 * M_PI * (r->rounds + 1);
    for (int i = 0; i < r->n; i++) {
        if (r->turns[i] && fabs(q[i] - r->start.q[i]) >= turn) {
            return i;
        }
    }
    return -1;
}

/// Coordinate i at the share x between the last state and (t, q, v), by cubic Hermite
/// interpolation.
static double between(const hn_round_trip *r, int i, double x, double h, const double *q,
                      const double *v) {
    const double whole = x * x * (3 - 2 * x), first = x * (1 - x) * (1 - x) * h,
                 last = -x * x * (1 - x) * h;
    return r->last.q[i] + whole * (q[i] - r->last.q[i]) + first * r->last.v[i] + last * v[i];
}

/// The configuration, in `there`, at which joint i stands `rounds` full turns from its start.
static void find_there(hn_round_trip *r, int i, double t, const double *q, const double *v) {
    const double h = t - r->last.t, way = q[i] - r->start.q[i];
    const double goal = r->start.q[i] + copysign(2 * M_PI * r->rounds, way);
    double low = 0, high = 1;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (low + high);
        const bool before = (between(r, i, middle, h, q, v) - goal) * way < 0;
        *(before ? &low : &high) = middle;
    }
    for (int k = 0; k < r->n; k++) {
        r->there[k] = between(r, k, high, h, q, v);
    }
}

/// Returns whether all coordinates are back at the start, angles by full turns.
static bool is_back(const hn_round_trip *r) {
    for (int i = 0; i < r->n; i++) {
        double apart = r->there[i] - r->start.q[i];
        if (r->turns[i]) {
            apart -= 2 * M_PI * round(apart / (2 * M_PI));
        }
        if (!(fabs(apart) <= BACK * r->unit[i])) {
            return false;
        }
    }
    return true;
}

const double *hn_round_trip_look(hn_round_trip *r, double t, const double *q, const double *v,
                                 double sigma, double *start) {
    const double *found = NULL;
    if (!r->serves) {
        return NULL;
    }
    if (!r->begun || (r->closed && sigma < BELOW * r->lowest_round)) {
        begin(r, t, q, v, sigma);
        return NULL;
    }
    r->lowest = fmin(r->lowest, sigma);

    // a joint has turned round once more: the way closes, is closed still, or is another one now
    const int turned = find_turned(r, q);
    if (turned >= 0) {
        r->rounds++;
        find_there(r, turned, t, q, v);
        if (is_back(r)) {
            r->closed = true;
            r->lowest_round = r->lowest;
            *start = r->sigma_start;
            found = r->there;
        } else if (r->closed) {
            begin(r, t, q, v, sigma);
            return NULL;
        }
    }
    put(r, &r->last, t, q, v);
    return found;
}
