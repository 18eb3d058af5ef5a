// SPDX-License-Identifier: GPL-3.0-or-later
#include "integrators/method/method_spec.h"

#include "base/suggest.h"
#include "formulations/list/formulation_list.h"
#include "integrators/list/stepper_list.h"
#include "integrators/method/guest.h"

#include <ctype.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_NAMES = 64, MAX_WORD = 64 };

// A piece of the text being parsed; columns are counted from the start of the whole.
typedef struct piece {
    const char *text; // the whole
    size_t from, to;
} piece;

static piece trim(piece p) {
    while (p.from < p.to && isspace((unsigned char)p.text[p.from])) {
        p.from++;
    }
    while (p.to > p.from && isspace((unsigned char)p.text[p.to - 1])) {
        p.to--;
    }
    return p;
}

static void copy_word(piece p, char word[MAX_WORD]) {
    p = trim(p);
    size_t n = p.to - p.from;
    n = n < MAX_WORD - 1 ? n : MAX_WORD - 1;
    memcpy(word, p.text + p.from, n);
    word[n] = '\0';
}

static hn_status at_column(hn_diag *diag, piece p, hn_status status) {
    if (diag) {
        diag->column = (int)trim(p).from + 1;
    }
    return status;
}

// first position of `c` in the piece, or its end
static size_t find_char(piece p, char c) {
    const char *hit = memchr(p.text + p.from, c, p.to - p.from);
    return hit ? (size_t)(hit - p.text) : p.to;
}

/// Writes the spelling of a program where a word looks like a file, which no formulation does.
static bool suggest_program(const char *word, char hint[HN_DIAG_HINT]) {
    const bool is_file = strpbrk(word, "/.") != NULL && strncmp(word, "program:", 8) != 0;
    if (is_file) {
        snprintf(hint, HN_DIAG_HINT, "a program of your own is spelled program:%.100s@rk4:h=1e-3",
                 word);
    }
    return is_file;
}

static hn_status unknown_name(hn_diag *diag, piece p, const char *what, const char *word,
                              const char *const *names, int n) {
    char hint[HN_DIAG_HINT];
    if (strcmp(what, "formulation") != 0 || !suggest_program(word, hint)) {
        hn_suggest(hint, word, names, n, NULL);
    }
    char list[HN_DIAG_MESSAGE - 128] = ""; // the rest of the message is shorter
    size_t used = 0;
    for (int i = 0; i < n; i++) {
        const bool fits = used + strlen(", ") + strlen(names[i]) + sizeof ", ..." <= sizeof list;
        used += (size_t)snprintf(list + used, sizeof list - used, "%s%s", i ? ", " : "",
                                 fits ? names[i] : "...");
        if (!fits) {
            break;
        }
    }
    hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "%s '%s' is not known; there are: %s", what, word,
                n > 0 ? list : "none");
    return at_column(diag, p, HN_ERR_INPUT);
}

static hn_status wrong_side(hn_diag *diag, piece p, const char *word, const char *is) {
    hn_diag_set(diag, HN_ERR_INPUT, NULL, "FORMULATION@INTEGRATOR, as in projection@rk4:h=1e-3",
                "'%s' is %s and stands on the wrong side of the '@'", word, is);
    return at_column(diag, p, HN_ERR_INPUT);
}

static hn_status find_formulation(piece p, const hn_formulation **out, hn_diag *diag) {
    const char *names[MAX_NAMES];
    char word[MAX_WORD];
    const int n = hn_formulation_count() < MAX_NAMES ? hn_formulation_count() : MAX_NAMES;
    copy_word(p, word);
    *out = hn_formulation_find(word);
    for (int i = 0; i < n; i++) {
        names[i] = hn_formulation_at(i)->name;
    }
    if (!*out && hn_stepper_find(word)) {
        return wrong_side(diag, p, word, "an integrator");
    }
    return *out ? HN_OK : unknown_name(diag, p, "formulation", word, names, n);
}

/// A text without '@': the formulation that is nearest to it, with an integrator, or an example.
static hn_status no_integrator(hn_diag *diag, piece all) {
    enum { SHOWN = 64 };
    const char *names[MAX_NAMES];
    char word[MAX_WORD], hint[HN_DIAG_HINT];
    const int n = hn_formulation_count() < MAX_NAMES ? hn_formulation_count() : MAX_NAMES;
    for (int i = 0; i < n; i++) {
        names[i] = hn_formulation_at(i)->name;
    }
    copy_word((piece){all.text, 0, find_char(all, ':')}, word);
    const char *meant = hn_formulation_find(word) ? word : hn_nearest_name(word, names, n);

    if (!suggest_program(word, hint)) {
        snprintf(hint, sizeof hint,
                 "write for example %.*s@rk4:h=1e-3; 'holonom list methods' names them all", SHOWN,
                 meant ? meant : "projection");
    }
    hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                "'%.60s' names no method: a formulation, '@' and an integrator are needed",
                all.text);
    if (diag) {
        diag->column = (int)all.to + 1;
    }
    return HN_ERR_INPUT;
}

static hn_status find_stepper(piece p, const hn_stepper **out, hn_diag *diag) {
    const char *names[MAX_NAMES];
    char word[MAX_WORD];
    const int n = hn_stepper_count() < MAX_NAMES ? hn_stepper_count() : MAX_NAMES;
    copy_word(p, word);
    *out = hn_stepper_find(word);
    for (int i = 0; i < n; i++) {
        names[i] = hn_stepper_at(i)->name;
    }
    if (!*out && hn_formulation_find(word)) {
        return wrong_side(diag, p, word, "a formulation");
    }
    return *out ? HN_OK : unknown_name(diag, p, "integrator", word, names, n);
}

// program:FILE, and the integrator behind the '@'; without one the program makes its own steps
static hn_status find_guest(piece left, piece right, hn_method_spec *spec, hn_diag *diag) {
    char name[HN_SPEC_MAX], word[MAX_WORD];
    hn_guest guest;
    snprintf(name, sizeof name, "%.*s", (int)(left.to - left.from), left.text + left.from);
    HN_TRY(hn_guest_find(name, &guest, diag));
    spec->formulation = guest.formulation;
    spec->stepper = guest.stepper;
    copy_word(right, word);
    return word[0] == '\0' || strcmp(word, guest.stepper->name) == 0
               ? HN_OK
               : find_stepper(right, &spec->stepper, diag);
}

/// The options of a formulation or of an integrator, and the one beyond the '@'.
typedef struct side_options {
    const char *name;
    const hn_option *table;
    int n;
    const struct side_options *other;
} side_options;

/// Reports an option that this side lacks: it may belong beyond the '@'.
static hn_status unknown_option(hn_diag *diag, piece p, const char *key, const side_options *own) {
    const char *keys[HN_MAX_OPTIONS];
    for (int i = 0; i < own->n; i++) {
        keys[i] = own->table[i].key;
    }
    const side_options *other = own->other;
    for (int i = 0; i < other->n; i++) {
        if (strcmp(other->table[i].key, key) == 0) {
            char hint[HN_DIAG_HINT];
            snprintf(hint, sizeof hint, "write it behind that name: %.40s:%s=VALUE", other->name,
                     key);
            hn_diag_set(diag, HN_ERR_INPUT, NULL, hint, "option '%s' belongs to %s, not to %s", key,
                        other->name, own->name);
            return at_column(diag, p, HN_ERR_INPUT);
        }
    }
    return unknown_name(diag, p, "option", key, keys, own->n);
}

// One "key=value"; `given` has a bit per setting already seen.
static hn_status parse_option(piece p, const side_options *own, double *set, unsigned *given,
                              hn_diag *diag) {
    char key[MAX_WORD], value[MAX_WORD];
    const size_t equals = find_char(p, '=');
    const piece left = {p.text, p.from, equals};
    if (equals == p.to) {
        copy_word(p, value);
        hn_diag_set(
            diag, HN_ERR_INPUT, NULL, "options are written key=value, as in index1@rk4:h=1e-3",
            value[0] ? "the option '%s' has no value" : "an option is missing here%s", value);
        return at_column(diag, p, HN_ERR_INPUT);
    }
    const piece right = {p.text, equals + 1, p.to};

    // the option of this name, given once
    copy_word(left, key);
    copy_word(right, value);
    for (int i = 0; i < own->n; i++) {
        if (strcmp(own->table[i].key, key) != 0) {
            continue;
        }
        if (*given & 1u << i) {
            hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s is given twice", key);
            return at_column(diag, left, HN_ERR_INPUT);
        }
        *given |= 1u << i;
        return at_column(diag, right, hn_option_parse(&own->table[i], value, &set[i], diag));
    }
    return unknown_option(diag, left, key, own);
}

// A comma followed by bare digits and no '=' is a decimal comma: "h=0,02" is one setting.
static size_t end_of_option(piece p) {
    size_t comma = find_char(p, ',');
    while (comma < p.to) {
        const piece rest = {p.text, comma + 1, p.to};
        const size_t next = find_char(rest, ',');
        const piece candidate = trim((piece){p.text, comma + 1, next});
        const int has_key = find_char(candidate, '=') < candidate.to;
        const int digits =
            candidate.from < candidate.to && isdigit((unsigned char)candidate.text[candidate.from]);
        if (has_key || !digits) {
            return comma;
        }
        comma = next;
    }
    return p.to;
}

static hn_status parse_options(piece p, const side_options *own, double *set, hn_diag *diag) {
    unsigned given = 0;
    for (;;) {
        const size_t end = end_of_option(p);
        const hn_status status = parse_option((piece){p.text, p.from, end}, own, set, &given, diag);
        if (status != HN_OK || end == p.to) {
            return status;
        }
        p.from = end + 1;
    }
}

static hn_status fill_defaults(piece p, const hn_option *table, int n, double *set, hn_diag *diag) {
    for (int i = 0; i < n; i++) {
        if (isnan(set[i])) {
            hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL, "%s is required", table[i].key);
            return at_column(diag, p, HN_ERR_INPUT);
        }
    }
    return HN_OK;
}

// name[:options] after the name was found; `colon` is where its options begin
static hn_status parse_side(piece side, size_t colon, const side_options *own, double *set,
                            hn_diag *diag) {
    for (int i = 0; i < HN_MAX_OPTIONS; i++) {
        set[i] = i < own->n ? own->table[i].initial : 0;
    }
    if (colon < side.to) {
        const piece options = {side.text, colon + 1, side.to};
        const hn_status status = parse_options(options, own, set, diag);
        if (status != HN_OK) {
            return status;
        }
    }
    return fill_defaults(side, own->table, own->n, set, diag);
}

static hn_status parse_sides(piece left, size_t left_colon, piece right, size_t right_colon,
                             hn_method_spec *spec, hn_diag *diag) {
    const hn_formulation *f = spec->formulation;
    const hn_stepper *s = spec->stepper;
    side_options of_formulation = {f->name, f->options, f->n_options, NULL};
    side_options of_integrator = {s->name, s->options, s->n_options, &of_formulation};
    of_formulation.other = &of_integrator;
    HN_TRY(parse_side(left, left_colon, &of_formulation, spec->formulation_set, diag));
    return parse_side(right, right_colon, &of_integrator, spec->stepper_set, diag);
}

static void warn_below_zero(const hn_option *table, int n, const double *set, hn_diag *diag) {
    for (int i = 0; i < n && diag; i++) {
        if (table[i].warn_below_zero && set[i] < 0) {
            snprintf(diag->message, sizeof diag->message,
                     "%s = %g %s is negative: it drives the loop open", table[i].key, set[i],
                     table[i].unit);
        }
    }
}

hn_dae_form hn_method_form(const hn_formulation *formulation, const hn_stepper *stepper) {
    const int own = formulation->alternative_form == HN_FORM_ODE ||
                    hn_stepper_serves(stepper, formulation->form);
    return own ? formulation->form : formulation->alternative_form;
}

int hn_method_fits(const hn_formulation *formulation, const hn_stepper *stepper) {
    return hn_stepper_serves(stepper, hn_method_form(formulation, stepper));
}

// names of what fits, as "a, b, c", ending in "..." where room runs out; returns how many there are
static int list_fitting(const hn_method_spec *spec, int integrators, char *list, size_t room) {
    const int n = integrators ? hn_stepper_count() : hn_formulation_count();
    size_t used = 0;
    int found = 0;
    list[0] = '\0';
    for (int i = 0; i < n; i++) {
        const hn_formulation *f = integrators ? spec->formulation : hn_formulation_at(i);
        const hn_stepper *s = integrators ? hn_stepper_at(i) : spec->stepper;
        if (!hn_method_fits(f, s)) {
            continue;
        }
        const char *name = integrators ? s->name : f->name, *comma = found++ ? ", " : "";
        if (used + strlen(comma) + strlen(name) + sizeof ", ..." > room) {
            snprintf(list + used, room - used, "%s", ", ...");
            break;
        }
        used += (size_t)snprintf(list + used, room - used, "%s%s", comma, name);
    }
    return found;
}

static hn_status check_pair(piece right, const hn_method_spec *spec, hn_diag *diag) {
    char list[HN_DIAG_MESSAGE / 2], served[HN_DIAG_HINT - MAX_WORD], hint[HN_DIAG_HINT];
    if (hn_method_fits(spec->formulation, spec->stepper)) {
        return HN_OK;
    }
    const int of_dae = spec->formulation->form != HN_FORM_ODE;
    list_fitting(spec, 0, served, sizeof served);
    snprintf(hint, sizeof hint, "%.40s serves %s", spec->stepper->name, served);
    const int n = list_fitting(spec, 1, list, sizeof list);
    const char *why = of_dae ? spec->stepper->unserved : NULL;
    hn_diag_set(diag, HN_ERR_INPUT, NULL, hint,
                "the formulation %s gives %s, which the integrator %s does not solve; %s%s%s%s",
                spec->formulation->name,
                of_dae ? "a differential-algebraic system" : "an ordinary differential equation",
                spec->stepper->name, n ? "choose one of " : "no integrator does", list,
                why ? "; " : "", why ? why : "");
    return at_column(diag, right, HN_ERR_INPUT);
}

hn_status hn_method_parse(const char *text, hn_method_spec *out, hn_diag *diag) {
    hn_method_spec spec = {0};
    const size_t n = strlen(text);
    if (diag) {
        *diag = (hn_diag){0};
    }

    // the parts of FORMULATION@INTEGRATOR
    const piece all = {text, 0, n};
    if (n >= HN_SPEC_MAX) {
        return hn_diag_set(diag, HN_ERR_INPUT, NULL, NULL,
                           "a method is spelled with at most %d characters, found %zu",
                           HN_SPEC_MAX - 1, n);
    }
    const bool guest = hn_guest_is_named(text);
    const size_t at = find_char(all, '@');
    if (at == n && !guest) {
        return no_integrator(diag, all);
    }
    const piece left = {text, 0, at}, right = {text, at < n ? at + 1 : n, n};
    const size_t right_colon = find_char(right, ':');
    size_t left_colon = find_char(left, ':');

    // names, whether they fit, and their options
    if (guest) {
        left_colon = at;
        HN_TRY(find_guest(left, (piece){text, right.from, right_colon}, &spec, diag));
    } else {
        HN_TRY(find_formulation((piece){text, 0, left_colon}, &spec.formulation, diag));
        HN_TRY(find_stepper((piece){text, right.from, right_colon}, &spec.stepper, diag));
    }
    HN_TRY(check_pair(right, &spec, diag));
    HN_TRY(parse_sides(left, left_colon, right, right_colon, &spec, diag));

    // no fault: the message may hold a warning
    if (diag) {
        *diag = (hn_diag){0};
    }
    warn_below_zero(spec.formulation->options, spec.formulation->n_options, spec.formulation_set,
                    diag);
    *out = spec;
    return HN_OK;
}

/// The place of a key in a table; n where it is not.
static int place_of(const hn_option *options, int n, const char *key) {
    int i = 0;
    while (i < n && strcmp(options[i].key, key) != 0) {
        i++;
    }
    return i;
}

double *hn_method_find_option(hn_method_spec *spec, const char *key, const hn_option **info) {
    const hn_formulation *f = spec->formulation;
    const hn_stepper *s = spec->stepper;
    const int i = place_of(f->options, f->n_options, key);
    const int k = place_of(s->options, s->n_options, key);
    if (i == f->n_options && k == s->n_options) {
        return NULL;
    }
    if (info) {
        *info = i < f->n_options ? &f->options[i] : &s->options[k];
    }
    return i < f->n_options ? &spec->formulation_set[i] : &spec->stepper_set[k];
}

double hn_method_option(const hn_method_spec *spec, const char *key, double otherwise) {
    hn_method_spec copy = *spec;
    const double *value = hn_method_find_option(&copy, key, NULL);
    return value ? *value : otherwise;
}

bool hn_method_is_adaptive(const hn_method_spec *spec) {
    return spec->stepper->adaptive && !(hn_method_option(spec, "h", 0) > 0);
}

// ---- writing ----

// a short text that reads back to the same double; six digits write 20 as 20, not as 2e+01
static void format_value(const hn_option *info, double value, char *out, size_t n) {
    if (info->choices) {
        snprintf(out, n, "%s", info->choices[(int)value]);
        return;
    }
    for (int digits = 6; digits <= 17; digits++) {
        snprintf(out, n, "%.*g", digits, value);
        if (strtod(out, NULL) == value) {
            break;
        }
    }
    // 20 reads better than 2e+01
    if (value == floor(value) && fabs(value) < 1e6) {
        snprintf(out, n, "%.0f", value);
    }
}

// the key that decides about accuracy and is written even where it has its default: h or rtol
static const char *key_of_accuracy(const hn_method_spec *spec) {
    return hn_method_is_adaptive(spec) ? "rtol" : "h";
}

static size_t format_side(const char *name, const hn_option *table, int n, const double *set,
                          const char *always, char *out, size_t room) {
    size_t used = 0;
    int wrote = snprintf(out, room, "%s", name);
    used += (size_t)wrote;
    char separator = ':';
    for (int i = 0; i < n && used < room; i++) {
        if (set[i] == table[i].initial && strcmp(table[i].key, always) != 0) {
            continue;
        }
        char value[MAX_WORD];
        format_value(&table[i], set[i], value, sizeof value);
        wrote = snprintf(out + used, room - used, "%c%s=%s", separator, table[i].key, value);
        used += (size_t)wrote;
        separator = ',';
    }
    return used;
}

void hn_method_format(const hn_method_spec *spec, char out[HN_SPEC_MAX]) {
    const char *always = key_of_accuracy(spec);
    size_t used =
        format_side(spec->formulation->name, spec->formulation->options,
                    spec->formulation->n_options, spec->formulation_set, always, out, HN_SPEC_MAX);
    HN_ASSERT(used + 1 < HN_SPEC_MAX);
    out[used++] = '@';
    used += format_side(spec->stepper->name, spec->stepper->options, spec->stepper->n_options,
                        spec->stepper_set, always, out + used, HN_SPEC_MAX - used);
    HN_ASSERT(used < HN_SPEC_MAX);
}

static void put_values(hn_strbuf *b, const hn_option *table, int n, const double *set) {
    for (int i = 0; i < n; i++) {
        if (table[i].choices) {
            hn_json_put_string(b, table[i].key, table[i].choices[(int)set[i]]);
        } else {
            hn_json_put_number(b, table[i].key, set[i]);
        }
    }
}

void hn_method_json(hn_strbuf *b, const hn_method_spec *spec) {
    char spelling[HN_SPEC_MAX], title[HN_SPEC_MAX];
    hn_method_format(spec, spelling);
    snprintf(title, sizeof title, "%s, %s", spec->formulation->title, spec->stepper->title);
    hn_json_object(b);
    hn_json_put_string(b, "spelling", spelling);
    hn_json_put_string(b, "formulation", spec->formulation->name);
    hn_json_put_string(b, "integrator", spec->stepper->name);
    hn_json_put_string(b, "title", title);
    hn_json_put_string(b, "short_name", spec->formulation->short_name);
    hn_json_put_bool(b, "model_error", spec->formulation->model_error);
    hn_json_key(b, "options");
    hn_json_object(b);
    put_values(b, spec->formulation->options, spec->formulation->n_options, spec->formulation_set);
    put_values(b, spec->stepper->options, spec->stepper->n_options, spec->stepper_set);
    hn_json_end_object(b);
    hn_json_end_object(b);
}
