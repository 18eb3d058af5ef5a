// SPDX-License-Identifier: GPL-3.0-or-later
#include "session/precision/study_part.h"

#include "session/precision/study_internal.h"
#include "session/precision/study_store.h"
#include "session/references/reference_store.h"
#include "session/references/references.h"

#include "base/hash.h"

static void put_scene(hn_strbuf *b, const hn_scene *scene) {
    char hex[17];
    hn_hash_hex(scene->hash, hex);
    hn_json_key(b, "scene");
    hn_json_object(b);
    hn_json_put_string(b, "id", scene->id);
    hn_json_put_string(b, "hash", hex);
    hn_json_key(b, "set");
    hn_json_object(b);
    for (int i = 0; i < scene->n_params; i++) {
        if (scene->params[i].value != scene->params[i].initial) {
            hn_json_put_number(b, scene->params[i].name, scene->params[i].value);
        }
    }
    hn_json_end_object(b);
    hn_json_key(b, "text");
    hn_json_raw(b, scene->text);
    hn_json_end_object(b);
}

/// The settings that decide the points: parts that differ in them are not of one study.
static void put_request(hn_strbuf *b, const hn_study *s) {
    hn_json_key(b, "request");
    hn_json_object(b);
    hn_json_put_number(b, "time", s->ref->T);
    hn_json_put_int(b, "levels", s->wp->n_levels);
    hn_json_put_int(b, "samples", s->wp->opts.n_samples);
    hn_json_put_number(b, "step", s->wp->opts.step);
    hn_json_key(b, "methods");
    hn_json_array(b);
    for (int m = 0; m < s->wp->n_methods; m++) {
        char spelling[HN_SPEC_MAX];
        hn_wp_spelling(s->wp, m, 0, spelling);
        hn_json_string(b, spelling);
    }
    hn_json_end_array(b);
    hn_json_end_object(b);
}

static void put_yardstick(hn_strbuf *b, const hn_wp *wp) {
    hn_json_key(b, "yardstick");
    hn_json_object(b);
    hn_json_put_int(b, "method", wp->yardstick_method);
    hn_json_put_numbers(b, "cpu", wp->yardstick.sample, (size_t)wp->yardstick.n_samples);
    hn_json_end_object(b);
}

static void put_points(hn_strbuf *b, const hn_study *s) {
    hn_json_key(b, "points");
    hn_json_array(b);
    for (int m = 0; m < s->wp->n_methods; m++) {
        for (int k = 0; k < s->wp->n_levels; k++) {
            const hn_wp_point *p = &s->wp->methods[m].point[k];
            if (p->state == HN_WP_PENDING) {
                continue;
            }
            hn_json_object(b);
            hn_store_put_point(b, s, m, k);
            hn_json_put_number(b, "first_cpu", p->first_cpu);
            hn_json_put_numbers(b, "cpu", p->sample, (size_t)p->n_samples);
            hn_json_put_int(b, "busy", p->busy);
            hn_json_end_object(b);
        }
    }
    hn_json_end_array(b);
}

void hn_study_part(hn_strbuf *b, const hn_study *s) {
    const hn_wp_opts *o = &s->wp->opts;
    hn_json_object(b);
    hn_json_put_string(b, "study", HN_PART_STUDY);
    hn_json_put_int(b, "format", HN_PART_FORMAT);
    hn_json_put_string(b, "build", s->request.build ? s->request.build : "");
    hn_json_put_int(b, "shard", o->n_shards > 0 ? o->shard : 1);
    hn_json_put_int(b, "of", o->n_shards > 0 ? o->n_shards : 1);
    put_scene(b, hn_model_scene(s->model));
    put_request(b, s);
    hn_json_put_number(b, "time_limit", s->request.limits.time_limit);
    hn_json_put_number(b, "elapsed", s->wp->elapsed);
    put_yardstick(b, s->wp);
    put_points(b, s);
    hn_json_key(b, "reference");
    hn_reference_put(b, s->model, s->ref);
    hn_json_end_object(b);
}
