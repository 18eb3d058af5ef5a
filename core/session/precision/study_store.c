// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_store.h"

#include "session/store/ending_json.h"

#include "session/precision/study_internal.h"
#include "session/store/stored_json.h"

#include "base/hash.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

// counted up when the meaning of a line changes
enum { FORMAT = 4, N_NUMBERS = 5 };
static const double LARGEST_COUNT = 9e15; // whole numbers are exact up to here

/// Returns the hash of everything that determines the points; the time limit does not. A part of a
/// study has its own journal.
static uint64_t study_key(const hn_study *s) {
    uint64_t hash = hn_hash_bytes(HN_HASH_START, &s->ref->scene, sizeof s->ref->scene);
    hash = hn_hash_double(hash, s->ref->T);
    hash = hn_hash_double(hash, s->ref->n + 1000.0 * FORMAT);
    hash = hn_hash_double(hash, s->wp->n_levels);
    hash = hn_hash_double(hash, s->wp->opts.step);
    for (int m = 0; m < s->wp->n_methods; m++) {
        char spelling[HN_SPEC_MAX];
        hn_wp_spelling(s->wp, m, 0, spelling);
        hash = hn_hash_text(hash, spelling);
    }
    if (s->wp->opts.n_shards > 1) {
        hash = hn_hash_double(hash, s->wp->opts.shard + 1e-3 * s->wp->opts.n_shards);
    }
    return hn_hash_mix(hash);
}

/// The counters of a cost, in the order they are written.
enum { N_COUNTS = 11, ENERGY = 8 }; // ENERGY is no count, and need not be finite
static void counts_of(const hn_cost *c, double out[N_COUNTS]) {
    const double list[N_COUNTS] = {(double)c->evals,
                                   (double)c->factorisations,
                                   (double)c->solves,
                                   (double)c->newton,
                                   c->ops,
                                   (double)c->fallbacks,
                                   (double)c->refinements,
                                   (double)c->projections,
                                   c->energy_removed,
                                   (double)c->chart_changes,
                                   (double)c->rejected};
    memcpy(out, list, sizeof list);
}

static hn_cost cost_of(const double n[N_COUNTS]) {
    return (hn_cost){.evals = (long long)n[0],
                     .factorisations = (long long)n[1],
                     .solves = (long long)n[2],
                     .newton = (long long)n[3],
                     .ops = n[4],
                     .fallbacks = (long long)n[5],
                     .refinements = (long long)n[6],
                     .projections = (long long)n[7],
                     .energy_removed = n[8],
                     .chart_changes = (long long)n[9],
                     .rejected = (long long)n[10]};
}

void hn_store_put_point(hn_strbuf *b, const hn_study *s, int m, int k) {
    const hn_wp_point *p = &s->wp->methods[m].point[k];
    double counts[N_COUNTS];
    counts_of(&p->cost, counts);
    const double numbers[N_NUMBERS] = {p->t_reached, (double)p->steps, (double)p->rejected,
                                       (double)p->times, (double)p->too_long};
    hn_json_put_int(b, "m", m);
    hn_json_put_int(b, "k", k);
    hn_json_put_int(b, "state", p->state);
    hn_json_put_int(b, "status", p->status);
    hn_json_put_string(b, "reason", p->reason);
    hn_ending_put_json(b, &p->ending, p->reason, p->t_reached);
    hn_json_put_numbers(b, "numbers", numbers, N_NUMBERS);
    hn_json_put_numbers(b, "worst", p->worst, HN_ERROR_COUNT);
    hn_json_put_numbers(b, "end", p->end, HN_ERROR_COUNT);
    hn_json_put_numbers(b, "q", p->end_q, (size_t)s->ref->n_user);
    hn_json_put_numbers(b, "cost", counts, N_COUNTS);
}

/// Returns 1 when all values fit a counter.
static int are_counts(const double *n, int count) {
    int ok = 1;
    for (int i = 0; i < count; i++) {
        ok = ok && fabs(n[i]) <= LARGEST_COUNT; // false for NaN too
    }
    return ok;
}

bool hn_store_take_point(const hn_study *s, const cJSON *o, hn_wp_point *p) {
    // every member must be there and in range
    double state, status, numbers[N_NUMBERS], counts[N_COUNTS];
    if (!hn_stored_number(o, "state", &state) || !hn_stored_number(o, "status", &status) ||
        !hn_stored_text(o, "reason", p->reason, sizeof p->reason) ||
        !hn_ending_take_json(o, &p->ending) ||
        !hn_stored_numbers(o, "numbers", numbers, N_NUMBERS) ||
        !hn_stored_numbers(o, "worst", p->worst, HN_ERROR_COUNT) ||
        !hn_stored_numbers(o, "end", p->end, HN_ERROR_COUNT) ||
        !hn_stored_numbers(o, "q", p->end_q, (size_t)s->ref->n_user) ||
        !hn_stored_numbers(o, "cost", counts, N_COUNTS) ||
        !are_counts(numbers + 1, N_NUMBERS - 1) || !(fabs(numbers[3]) <= INT_MAX) ||
        !are_counts(counts, ENERGY) || !are_counts(counts + ENERGY + 1, N_COUNTS - ENERGY - 1) ||
        !(status >= 0 && status < HN_STATUS_COUNT) ||
        (state != HN_WP_DONE && state != HN_WP_FAILED && state != HN_WP_SKIPPED)) {
        return false;
    }

    // a refused line never sets the state of the point
    p->state = (hn_wp_state)state;
    p->status = (hn_status)status;
    p->t_reached = numbers[0];
    p->steps = (long long)numbers[1];
    p->rejected = (long long)numbers[2];
    p->times = (int)numbers[3];
    p->too_long = numbers[4] != 0;
    p->cost = cost_of(counts);
    return true;
}

bool hn_store_take_sample(hn_wp_point *p, double cpu, double busy) {
    if (p->n_samples >= HN_WP_SAMPLES || !(cpu > 0) || !(busy >= 0 && busy <= HN_WP_SAMPLES)) {
        return false;
    }
    p->sample[p->n_samples++] = cpu;
    p->busy = (int)busy;
    hn_wp_point_statistics(p);
    return true;
}

/// Takes the line of a point. Returns 0 when it is not valid.
static int take_point_line(hn_study *s, const cJSON *o, hn_wp_point *p) {
    const int ok = hn_stored_number(o, "first_cpu", &p->first_cpu) &&
                   hn_store_take_point(s, o, p) && p->state != HN_WP_SKIPPED;
    s->resumed += ok;
    return ok;
}

static bool take_sample_line(hn_wp_point *p, const cJSON *o) {
    double cpu, busy;
    return hn_stored_number(o, "cpu", &cpu) && hn_stored_number(o, "busy", &busy) &&
           hn_store_take_sample(p, cpu, busy);
}

/// Takes one line of the journal; m = -1 is the yardstick.
static int take_line(void *user, const cJSON *o) {
    hn_study *s = user;
    const int is_sample = cJSON_HasObjectItem(o, "cpu");
    double m = -2, k = -1;
    if (!hn_stored_number(o, "m", &m) || !hn_stored_number(o, "k", &k) ||
        !(m >= -1 && k >= 0 && m < s->wp->n_methods && k < s->wp->n_levels)) {
        return 0;
    }
    if (m < 0) {
        return is_sample && take_sample_line(&s->wp->yardstick, o);
    }
    hn_wp_point *p = &s->wp->methods[(int)m].point[(int)k];
    return is_sample ? p->state == HN_WP_DONE && take_sample_line(p, o) : take_point_line(s, o, p);
}

hn_status hn_store_open(hn_study *s, hn_diags *diags) {
    return hn_journal_open(&s->journal, s->request.limits.folder, "study", study_key(s), take_line,
                           s, diags);
}

void hn_store_keep_point(hn_study *s, int m, int k) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_store_put_point(&b, s, m, k);
    hn_json_put_number(&b, "first_cpu", s->wp->methods[m].point[k].first_cpu);
    hn_journal_write(&s->journal, &b);
}

void hn_store_keep_sample(hn_study *s, int m, int k) {
    const hn_wp_point *p = m < 0 ? &s->wp->yardstick : &s->wp->methods[m].point[k];
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_json_object(&b);
    hn_json_put_int(&b, "m", m);
    hn_json_put_int(&b, "k", k);
    hn_json_put_number(&b, "cpu", p->sample[p->n_samples - 1]);
    hn_json_put_int(&b, "busy", p->busy);
    hn_journal_write(&s->journal, &b);
}
