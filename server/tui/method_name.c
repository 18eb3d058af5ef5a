// SPDX-License-Identifier: GPL-3.0-or-later
#include "tui/method_name.h"

#include "base/units.h"
#include "terminal/width.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEAST_STEM = 4 }; // letters of a name that is abbreviated

/// The fixed step of a method [s]; NaN: it has none.
static double step_of(const hn_track *t) {
    hn_method_spec spec;
    hn_diag diag = {0};
    const bool fixed =
        hn_method_parse(t->spelling, &spec, &diag) == HN_OK && !hn_method_is_adaptive(&spec);
    return fixed ? hn_method_option(&spec, "h", (double)NAN) : (double)NAN;
}

static bool differs(const hn_method_spec *spec, const hn_method_spec *than, int option) {
    const double value = spec->formulation_set[option];
    return value != spec->formulation->options[option].initial ||
           (than && value != than->formulation_set[option]);
}

/// Adds the options of the formulation that differ from their defaults, or from those of another
/// method (NULL: none): " 20/20" of Baumgarte, " unit-length". Both of two numbers are shown, of
/// more those that differ, with their keys.
static void add_options(const hn_method_spec *spec, const hn_method_spec *than, char *out,
                        size_t size) {
    const hn_formulation *f = spec->formulation;
    int numbers = 0, other = 0;
    for (int i = 0; i < f->n_options; i++) {
        const bool number = !f->options[i].choices;
        numbers += number;
        other += number && differs(spec, than, i);
    }
    const char *joint = " ";
    for (int i = 0; i < f->n_options; i++) {
        const hn_option *o = &f->options[i];
        const double value = spec->formulation_set[i];
        const bool own = differs(spec, than, i);
        const size_t n = strlen(out);
        if (o->choices && own) {
            snprintf(out + n, size - n, " %s", o->choices[(int)value]);
        } else if (!o->choices && numbers <= 2 && other > 0) {
            snprintf(out + n, size - n, "%s%.4g", joint, value);
            joint = "/";
        } else if (!o->choices && own) {
            snprintf(out + n, size - n, " %s=%.4g", o->key, value);
        }
    }
}

/// Takes the last word of a text away; false: it is one word alone.
static bool drop_word(char *text) {
    char *last = strrchr(text, ' ');
    if (last && last > text) {
        *last = '\0';
    }
    return last && last > text;
}

/// "Baumgarte" and " 20/20 20 ms" in `most` columns: where both are too long the name loses words
/// from its end, then is abbreviated, as its letters tell least; then the options lose words.
static void fit_name(const char *whole, char ending[HN_METHOD_NAME], int most,
                     char out[HN_METHOD_NAME]) {
    char name[HN_METHOD_NAME];
    snprintf(name, sizeof name, "%s", whole);
    snprintf(out, HN_METHOD_NAME, "%.40s%.22s", name, ending);
    if (hn_text_columns(out) <= most) {
        return;
    }
    const int room = most - hn_text_columns(ending);
    while (hn_text_columns(name) > room && strcspn(name, " ") >= LEAST_STEM && drop_word(name)) {}
    const size_t letters = strlen(name);
    const bool abbreviates = (int)letters > room && room >= LEAST_STEM && !strchr(name, ' ');
    if (abbreviates) {
        snprintf(name + room - 1, sizeof name - (size_t)room + 1, ".");
    }

    // options from the last on
    bool cut = false;
    while (hn_text_columns(name) + hn_text_columns(ending) + cut > most && drop_word(ending)) {
        cut = true;
    }
    const int rest = most - hn_text_columns(name);
    const bool fits = hn_text_columns(ending) + cut <= rest;
    snprintf(out, HN_METHOD_NAME, "%.*s%.40s%s", most, name, fits ? ending : "",
             cut || !fits ? "…" : "");
}

void hn_method_name(const hn_workbench *w, int m, int most, char out[HN_METHOD_NAME]) {
    const hn_track *own = hn_recording_track(w->recording, m);
    hn_method_spec spec, like;
    hn_diag diag = {0};
    char ending[HN_METHOD_NAME] = "";
    bool shared = false, compared = false;
    const bool read = hn_method_parse(own->spelling, &spec, &diag) == HN_OK && spec.formulation;
    for (int i = 0; i < w->n_methods; i++) {
        const hn_track *other = hn_recording_track(w->recording, i);
        const bool named = i != m && strcmp(other->name, own->name) == 0;
        shared |= named && step_of(own) != step_of(other) && isfinite(step_of(own));
        if (read && named && !compared && hn_method_parse(other->spelling, &like, &diag) == HN_OK) {
            compared = like.formulation == spec.formulation &&
                       memcmp(like.formulation_set, spec.formulation_set,
                              sizeof like.formulation_set) != 0;
        }
    }
    if (read) {
        add_options(&spec, compared ? &like : NULL, ending, sizeof ending);
    }
    if (shared) {
        char step[HN_SI_TEXT];
        const size_t n = strlen(ending);
        hn_si_format(step_of(own), "s", 2, step);
        snprintf(ending + n, sizeof ending - n, " %s", step);
    }
    fit_name(own->name, ending, most, out);
}
