// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/method/catalogue.h"

#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "integrators/method/guest.h"
#include "integrators/method/method_spec.h"

#include <math.h>

static void put_option(hn_strbuf *b, const hn_option *info) {
    hn_json_object(b);
    hn_json_put_string(b, "key", info->key);
    hn_json_put_string(b, "unit", info->unit ? info->unit : "");
    hn_json_put_string(b, "about", info->about);
    if (info->choices) {
        hn_json_key(b, "choices");
        hn_json_strings(b, info->choices, (size_t)info->n_choices);
        hn_json_put_string(b, "default", info->choices[(int)info->initial]);
    } else {
        hn_json_put_number(b, "default", info->initial); // null: required
        hn_json_put_number(b, "min", info->min);
        hn_json_put_number(b, "max", info->max);
    }
    hn_json_put_bool(b, "warn_below_zero", info->warn_below_zero);
    hn_json_end_object(b);
}

static void put_options(hn_strbuf *b, const hn_option *table, int n) {
    hn_json_key(b, "options");
    hn_json_array(b);
    for (int i = 0; i < n; i++) {
        put_option(b, &table[i]);
    }
    hn_json_end_array(b);
}

static void put_optional(hn_strbuf *b, const char *key, const char *text) {
    hn_json_put_string(b, key, text ? text : "");
}

static void put_integrators_of(hn_strbuf *b, const hn_formulation *f) {
    hn_json_key(b, "integrators");
    hn_json_array(b);
    for (int i = 0; i < hn_stepper_count(); i++) {
        if (hn_method_fits(f, hn_stepper_at(i))) {
            hn_json_string(b, hn_stepper_at(i)->name);
        }
    }
    hn_json_end_array(b);
}

static void put_served_by(hn_strbuf *b, const hn_stepper *s) {
    hn_json_key(b, "forms");
    hn_json_array(b);
    for (int form = 0; form < HN_FORM_COUNT; form++) {
        if (hn_stepper_serves(s, (hn_dae_form)form)) {
            hn_json_string(b, hn_form_name((hn_dae_form)form));
        }
    }
    hn_json_end_array(b);
    hn_json_key(b, "serves");
    hn_json_array(b);
    for (int i = 0; i < hn_formulation_count(); i++) {
        if (hn_method_fits(hn_formulation_at(i), s)) {
            hn_json_string(b, hn_formulation_at(i)->name);
        }
    }
    hn_json_end_array(b);
}

static void put_formulation(hn_strbuf *b, const hn_formulation *f) {
    hn_json_object(b);
    hn_json_put_string(b, "name", f->name);
    hn_json_put_string(b, "title", f->title);
    hn_json_put_string(b, "short_name", f->short_name);
    hn_json_put_string(b, "rule", f->rule);
    hn_json_put_string(b, "drift", f->drift);
    hn_json_put_string(b, "when", f->when);
    hn_json_put_string(b, "when_not", f->when_not);
    hn_json_put_string(b, "source", f->source);
    hn_json_put_string(b, "needs", f->needs);
    put_optional(b, "order_note", f->order_note);
    put_optional(b, "limits", f->limits);
    hn_json_put_string(b, "form", hn_form_name(f->form));
    hn_json_put_int(b, "index", f->index);
    put_integrators_of(b, f);
    hn_json_put_bool(b, "model_error", f->model_error);
    hn_json_put_bool(b, "keeps_gap", (f->traits & HN_TRAIT_CLOSES_POSITION) != 0);
    put_options(b, f->options, f->n_options);
    hn_json_end_object(b);
}

// no limit is null: JSON has no infinity
static void put_stepper(hn_strbuf *b, const hn_stepper *s) {
    hn_json_object(b);
    hn_json_put_string(b, "name", s->name);
    hn_json_put_string(b, "title", s->title);
    hn_json_put_string(b, "about", s->about);
    hn_json_put_string(b, "source", s->source);
    hn_json_put_int(b, "order", s->order);
    hn_json_put_int(b, "stages", s->stages);
    hn_json_put_bool(b, "adaptive", s->adaptive);
    hn_json_put_bool(b, "partitioned", s->partitioned);
    hn_json_put_number(b, "real_limit", s->real_limit);
    hn_json_put_number(b, "imag_limit", s->imag_limit);
    hn_json_put_int(b, "dense_order", s->dense_order);
    put_served_by(b, s);
    put_options(b, s->options, s->n_options);
    hn_json_end_object(b);
}

void hn_methods_json(hn_strbuf *b) {
    hn_json_object(b);
    hn_json_key(b, "formulations");
    hn_json_array(b);
    for (int i = 0; i < hn_formulation_count(); i++) {
        put_formulation(b, hn_formulation_at(i));
    }
    hn_json_end_array(b);
    hn_json_key(b, "integrators");
    hn_json_array(b);
    for (int i = 0; i < hn_stepper_count(); i++) {
        put_stepper(b, hn_stepper_at(i));
    }
    hn_json_end_array(b);

    // programs of one's own, where they are allowed
    hn_json_key(b, "programs");
    hn_json_array(b);
    hn_guest_list(b);
    hn_json_end_array(b);
    hn_json_end_object(b);
}
