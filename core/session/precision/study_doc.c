// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_doc.h"

#include "session/precision/study_internal.h"
#include "session/precision/wanted.h"
#include "session/store/cost_json.h"
#include "session/store/csv.h"
#include "session/store/ending_json.h"

#include "base/hash.h"
#include "render/look.h"

#include <math.h>

static void put_errors(hn_strbuf *b, const char *key, const double e[HN_ERROR_COUNT]) {
    hn_json_key(b, key);
    hn_json_object(b);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        hn_json_put_number(b, hn_error_name((hn_error_kind)i), e[i]);
    }
    hn_json_end_object(b);
}

static void put_reference(hn_strbuf *b, const hn_study *s) {
    hn_json_key(b, "reference");
    hn_json_object(b);

    // the two computations, and how far they agree
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int i = 0; i < HN_REF_MEANS; i++) {
        hn_json_string(b, s->ref->means[i]);
    }
    hn_json_end_array(b);
    hn_json_put_number(b, "digits", hn_ref_digits(s->ref));
    put_errors(b, "error", s->ref->error);
    hn_json_put_int(b, "times", hn_study_times(s));
    if (s->ref->refused[0]) {
        hn_json_put_string(b, "refused", s->ref->refused);
    }

    // scales by which errors are divided
    hn_json_key(b, "scales");
    hn_json_object(b);
    hn_json_put_number(b, "length", s->ref->scales.length);
    hn_json_put_number(b, "rate", s->ref->scales.rate);
    hn_json_put_number(b, "reaction", s->ref->scales.reaction);
    hn_json_put_number(b, "energy", s->ref->scales.energy);
    hn_json_end_object(b);
    hn_json_end_object(b);
}

static void put_chaos(hn_strbuf *b, const hn_study *s) {
    hn_json_key(b, "chaos");
    hn_json_object(b);
    hn_json_put_bool(b, "possible", s->chaos.possible);
    hn_json_put_bool(b, "chaotic", s->chaos.chaotic);
    hn_json_put_number(b, "exponent", s->chaos.exponent);
    hn_json_put_number(b, "horizon", s->wp->horizon > 0 ? s->wp->horizon : (double)NAN);
    hn_json_put_string(b, "text", s->chaos.why);
    hn_json_end_object(b);
}

static void put_class(hn_strbuf *b, const hn_class *c) {
    hn_json_key(b, "class");
    hn_json_object(b);
    hn_json_put_string(b, "kind", hn_class_name(c->kind));
    hn_json_put_string(b, "text", c->text);
    hn_json_put_number(b, "order", c->order);
    hn_json_put_number(b, "theory", c->theory);
    hn_json_put_bool(b, "as_theory", c->as_theory);
    hn_json_put_number(b, "floor", c->floor);
    if (c->kind == HN_CLASS_ELSEWHERE) {
        hn_json_put_number(b, "offset", c->offset);
    }
    hn_json_end_object(b);
}

static void put_times(hn_strbuf *b, const hn_wp_point *p) {
    hn_json_key(b, "cpu");
    hn_json_object(b);
    hn_json_put_number(b, "median", p->median);
    hn_json_put_number(b, "spread", p->spread);
    hn_json_put_number(b, "low", p->low);
    hn_json_put_number(b, "high", p->high);
    hn_json_put_numbers(b, "halves", p->half, 2);
    hn_json_put_int(b, "samples", p->n_samples);
    hn_json_put_int(b, "busy", p->busy);
    hn_json_end_object(b);
}

/// Writes the kinds of error that are only bounds, because the reference does not resolve them.
static void put_bounds(hn_strbuf *b, const hn_wp *wp, const hn_wp_point *p) {
    hn_json_key(b, "bounds");
    hn_json_array(b);
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        if (wp->ref->error[i] > 0 && !hn_wp_is_resolved(wp, (hn_error_kind)i, p->worst[i])) {
            hn_json_string(b, hn_error_name((hn_error_kind)i));
        }
    }
    hn_json_end_array(b);
}

static void put_point(hn_strbuf *b, const hn_study *s, int m, int k) {
    const hn_wp_point *p = &s->wp->methods[m].point[k];
    char spelling[HN_SPEC_MAX];
    hn_wp_spelling(s->wp, m, k, spelling);

    // method, size and outcome
    hn_json_object(b);
    hn_json_put_string(b, "method", spelling);
    hn_json_put_number(b, "size", p->size);
    hn_json_put_string(b, "state", hn_wp_state_name(p->state));
    hn_json_put_string(b, "status", hn_status_name(p->status));
    hn_json_put_string(b, "reason", p->reason);
    hn_ending_put_json(b, &p->ending, p->reason, p->t_reached);

    // cost until the end or the failure
    if (p->state == HN_WP_DONE || p->state == HN_WP_FAILED) {
        hn_json_put_number(b, "t_reached", p->t_reached);
        hn_json_put_int(b, "steps", p->steps);
        hn_json_put_int(b, "rejected", p->rejected);
        hn_json_put_int(b, "evaluations", p->cost.evals);
        hn_cost_put_ops_json(b, "operations", &p->cost);
        hn_cost_put_reason_json(b, "operations_reason", &p->cost);
        hn_json_put_int(b, "factorisations", p->cost.factorisations);
        hn_json_put_int(b, "solves", p->cost.solves);
        hn_json_put_int(b, "newton", p->cost.newton);
    }

    // errors and times of a complete run
    if (p->state == HN_WP_DONE) {
        put_errors(b, "worst", p->worst);
        put_errors(b, "end", p->end);
        put_bounds(b, s->wp, p);
        put_times(b, p);
    }
    hn_json_end_object(b);
}

static void put_methods(hn_strbuf *b, const hn_study *s) {
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int m = 0; m < s->wp->n_methods; m++) {
        const hn_wp_method *method = &s->wp->methods[m];
        hn_json_object(b);
        hn_json_put_string(b, "method", method->spelling);
        hn_json_put_int(b, "slot", hn_look_slot(m));
        hn_json_put_bool(b, "adaptive", method->adaptive);
        hn_json_put_string(b, "size", method->adaptive ? "rtol" : "h");
        put_class(b, &s->classes[m]);
        hn_json_key(b, "points");
        hn_json_array(b);
        for (int k = 0; k < s->wp->n_levels; k++) {
            put_point(b, s, m, k);
        }
        hn_json_end_array(b);
        hn_json_end_object(b);
    }
    hn_json_end_array(b);
}

static void put_place(hn_strbuf *b, const hn_study *s, const char *key, hn_place place) {
    if (place.level >= 0) {
        const hn_wp_point *p = &s->wp->methods[place.method].point[place.level];
        hn_json_key(b, key);
        hn_json_object(b);
        hn_json_put_string(b, "method", s->wp->methods[place.method].spelling);
        hn_json_put_number(b, "size", p->size);
        hn_json_put_number(b, "cost", place.cost);
        hn_json_end_object(b);
    }
}

static void put_band(hn_strbuf *b, const hn_study *s, const hn_band *band) {
    hn_json_object(b);
    hn_json_put_number(b, "accuracy", band->accuracy);
    hn_json_put_string(b, "ranking", hn_ranking_name(band->ranking));
    put_place(b, s, "best", band->best);
    put_place(b, s, "next", band->next);
    hn_json_key(b, "too_close_to_rank");
    hn_json_array(b);
    for (int i = 0; i < band->n_close; i++) {
        hn_json_string(b, s->wp->methods[band->close[i].method].spelling);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

static void put_sentences(hn_strbuf *b, const hn_study *s, const hn_pareto *p) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_pareto_sentences(&text, s->wp, p);
    hn_json_put_string(b, "sentences", hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

static void put_paretos(hn_strbuf *b, const hn_study *s) {
    hn_json_key(b, "pareto");
    hn_json_array(b);

    // coordinates to reactions, and the error that the ranking uses
    const hn_error_kind also = hn_wp_ranked_error(s->wp);
    for (int error = HN_ERROR_Q; error < HN_ERROR_COUNT; error++) {
        if (error > HN_ERROR_REACTION && error != (int)also) {
            continue;
        }
        for (int cost = 0; cost < HN_COST_COUNT; cost++) {
            // one front for each pair of error and cost
            hn_pareto p;
            hn_wp_pareto(s->wp, s->classes, (hn_error_kind)error, (hn_cost_kind)cost, &p);
            hn_json_object(b);
            hn_json_put_string(b, "error", hn_error_name((hn_error_kind)error));
            hn_json_put_string(b, "cost", hn_cost_name((hn_cost_kind)cost));
            hn_json_put_bool(b, "ranked", !p.few && !p.clocks_differ && !p.beyond_horizon);
            put_sentences(b, s, &p);

            // cheapest methods, accuracy by accuracy
            hn_json_key(b, "bands");
            hn_json_array(b);
            for (int i = 0; i < p.n_bands; i++) {
                put_band(b, s, &p.band[i]);
            }
            hn_json_end_array(b);
            hn_json_end_object(b);
        }
    }
    hn_json_end_array(b);
}

static void put_race(hn_strbuf *b, const hn_study *s) {
    hn_race race;
    hn_wp_race(s->wp, s->classes, hn_wp_ranked_error(s->wp), &race);
    hn_json_key(b, "race");
    hn_json_object(b);
    hn_json_put_numbers(b, "operations", race.cost, (size_t)race.n);
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int m = 0; m < s->wp->n_methods; m++) {
        hn_json_array(b);
        for (int i = 0; i < race.n; i++) {
            hn_json_object(b);
            hn_json_put_number(b, "error", race.error[i][m]);
            hn_json_put_bool(b, "or_less", race.is_bound[i][m]);
            hn_json_end_object(b);
        }
        hn_json_end_array(b);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

/// Writes how points are read for a wanted accuracy (hn_wanted_text()), for who asks later.
static void put_rule(hn_strbuf *b) {
    hn_json_key(b, "wanted");
    hn_json_object(b);
    hn_json_put_number(b, "margin", HN_WANTED_MARGIN);
    hn_json_put_number(b, "above_reference", HN_WP_ABOVE_REFERENCE);
    hn_json_end_object(b);
}

void hn_study_json(hn_strbuf *b, const hn_study *s) {
    const hn_scene *scene = hn_model_scene(s->model);
    char hex[17];
    hn_hash_hex(scene->hash, hex);

    // identity and state of the study
    hn_json_object(b);
    hn_json_put_string(b, "study", "work-precision");
    hn_json_put_string(b, "scene", scene->id);
    hn_json_put_string(b, "title", scene->title);
    hn_json_put_string(b, "scene_hash", hex);
    hn_json_put_number(b, "time", s->ref->T);
    hn_json_put_bool(b, "finished", !s->wp->out_of_time && !s->wp->stopped);
    hn_json_put_bool(b, "stopped", s->wp->stopped);
    hn_json_put_number(b, "time_limit", s->request.limits.time_limit);
    // without timing the document holds no clock value, so that two documents are equal byte by
    // byte
    hn_json_put_number(b, "elapsed", s->wp->opts.n_samples > 0 ? s->wp->elapsed : (double)NAN);

    // results
    put_reference(b, s);
    put_chaos(b, s);
    put_methods(b, s);
    put_paretos(b, s);
    put_race(b, s);
    put_rule(b);
    hn_json_end_object(b);
}

/// Writes a comma and a number.
static void put_cell(hn_strbuf *b, double value) {
    hn_strbuf_add(b, ",");
    hn_csv_number(b, value);
}

static void put_row(hn_strbuf *b, const hn_study *s, int m, int k) {
    const hn_wp_point *p = &s->wp->methods[m].point[k];
    const int done = p->state == HN_WP_DONE;
    hn_csv_text(b, s->wp->methods[m].spelling);
    put_cell(b, p->size);
    hn_strbuf_printf(b, ",%s", hn_wp_state_name(p->state));
    put_cell(b, done || p->state == HN_WP_FAILED ? p->t_reached : (double)NAN);

    // errors: largest over the run, then at the end
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        put_cell(b, done ? p->worst[i] : (double)NAN);
    }
    for (int i = 0; i < HN_ERROR_COUNT; i++) {
        put_cell(b, done ? p->end[i] : (double)NAN);
    }

    // cost and times
    put_cell(b, (double)p->steps);
    put_cell(b, (double)p->rejected);
    put_cell(b, (double)p->cost.evals);
    put_cell(b, hn_cost_known_ops(&p->cost));
    put_cell(b, p->median);
    put_cell(b, p->spread);
    put_cell(b, p->half[0]);
    put_cell(b, p->half[1]);
    put_cell(b, p->n_samples);
    put_cell(b, p->busy);

    // verdict on the method, reason of the point
    hn_strbuf_printf(b, ",%s,", hn_class_name(s->classes[m].kind));
    hn_csv_text(b, p->reason);
    hn_strbuf_add(b, "\n");
}

void hn_study_csv(hn_strbuf *b, const hn_study *s) {
    static const char *const when[] = {"worst", "end"};
    hn_strbuf_add(b, "method,size,state,t_reached");
    for (int w = 0; w < 2; w++) {
        for (int i = 0; i < HN_ERROR_COUNT; i++) {
            hn_strbuf_printf(b, ",%s_%s", when[w], hn_error_name((hn_error_kind)i));
        }
    }
    hn_strbuf_add(b, ",steps,rejected,evaluations,operations,cpu_median,cpu_spread,cpu_first_half,"
                     "cpu_second_half,samples,busy,"
                     "class,reason\n");
    for (int m = 0; m < s->wp->n_methods; m++) {
        for (int k = 0; k < s->wp->n_levels; k++) {
            put_row(b, s, m, k);
        }
    }
}
