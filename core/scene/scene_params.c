// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters: a number or a formula of other parameters, a unit, a range.

#include "base/units.h"
#include "scene/reader.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LEAST_DIGITS = 6 }; // of numbers in messages

static const char *const UNITS[] = {
    "",      "1",      "m",   "kg",    "s",       "rad",       "N", "N*m", "m/s", "rad/s",
    "m/s^2", "kg*m^2", "N/m", "N*s/m", "N*m/rad", "N*m*s/rad", "J", "W",   "Hz"};
enum { N_UNITS = sizeof UNITS / sizeof UNITS[0] };

/// Units people bring along, and what to write instead.
static const struct {
    const char *unit, *hint;
} FOREIGN[] = {
    {"deg", "use rad: 30 deg = 0.5236 rad"},
    {"degree", "use rad: 30 deg = 0.5236 rad"},
    {"degrees", "use rad: 30 deg = 0.5236 rad"},
    {"deg/s", "use rad/s: 1 deg/s = 0.017453 rad/s"},
    {"rpm", "use rad/s: 1 rpm = 0.10472 rad/s"},
    {"mm", "use m: 1 mm = 0.001 m"},
    {"cm", "use m: 1 cm = 0.01 m"},
    {"km", "use m: 1 km = 1000 m"},
    {"in", "use m: 1 in = 0.0254 m"},
    {"ft", "use m: 1 ft = 0.3048 m"},
    {"g", "use kg: 1 g = 0.001 kg"},
    {"lb", "use kg: 1 lb = 0.45359 kg"},
    {"ms", "use s: 1 ms = 0.001 s"},
    {"min", "use s: 1 min = 60 s"},
    {"Nm", "write N*m"},
    {"kN", "use N: 1 kN = 1000 N"},
    {"N*mm", "use N*m: 1 N*mm = 0.001 N*m"},
    {"1/s", "write Hz or rad/s"},
};

static void check_unit(hn_reader *r, const char *unit) {
    for (int i = 0; i < N_UNITS; i++) {
        if (strcmp(unit, UNITS[i]) == 0) {
            return;
        }
    }

    // units of other systems come with their conversion
    for (size_t i = 0; i < sizeof FOREIGN / sizeof FOREIGN[0]; i++) {
        if (strcmp(unit, FOREIGN[i].unit) == 0) {
            hn_rd_fault_at(r, "unit", FOREIGN[i].hint,
                           "the unit '%s' is not supported; numbers are in SI units", unit);
            return;
        }
    }

    // anything else may be a slip of the pen
    char hint[HN_DIAG_HINT];
    hn_rd_suggest(hint, sizeof hint, unit, UNITS + 1, N_UNITS - 1);
    hn_rd_fault_at(r, "unit", hint, "unknown unit '%.40s'", unit);
}

/// The value as written: a number or the text of a formula; NULL after a fault.
static const cJSON *find_value(hn_reader *r, const cJSON *node) {
    static const char *const fields[] = {"value", "unit", "min", "max", "integer", "about"};
    const cJSON *value = cJSON_IsObject(node) ? hn_rd_get(node, "value") : node;
    if (cJSON_IsObject(node)) {
        hn_rd_object(r, node, "a parameter", fields, 6);
    }
    if (!value) {
        hn_rd_fault(r, NULL, "the field 'value' is missing");
    } else if (!cJSON_IsNumber(value) && !cJSON_IsString(value)) {
        hn_rd_fault(r, NULL, "expected a number or a formula in quotes, found %s",
                    hn_rd_kind(value));
        value = NULL;
    }
    return value;
}

/// Adds a parameter and its source to their lists.
static void add_param(hn_reader *r, const hn_param *p, const hn_rd_param *source) {
    hn_scene *s = r->scene;
    hn_param *params =
        hn_rd_grow(r, s->params, s->n_params, sizeof *params, HN_SCENE_MAX_PARAMS, "parameters");
    hn_rd_param *src = params ? hn_rd_grow(r, r->param_src, s->n_params, sizeof *src,
                                           HN_SCENE_MAX_PARAMS, "parameters")
                              : NULL;
    if (!src) {
        return;
    }
    s->params = params;
    r->param_src = src;
    params[s->n_params] = *p;
    src[s->n_params] = *source;
    if (p->name) {
        s->n_params++;
        hn_rd_put_name(r, HN_RD_PARAM, s->n_params - 1);
    }
}

/// Name, unit and words of one parameter; its value comes once all names are known.
static void read_param(hn_reader *r, const cJSON *node, const char *key) {
    bool named = hn_rd_check_identifier(r, key);
    const cJSON *value = find_value(r, node);
    const char *unit = hn_rd_text(r, node, "unit", 0), *about = hn_rd_text(r, node, "about", 0);
    hn_param p = {.name = hn_rd_keep(r, key),
                  .unit = unit && strcmp(unit, "1") != 0 ? unit : "",
                  .about = about ? about : "",
                  .integer = hn_rd_flag(r, node, "integer"),
                  .min = -HUGE_VAL,
                  .max = HUGE_VAL,
                  .value = 1,
                  .initial = 1};
    if (unit) {
        check_unit(r, unit);
    }

    // after a fault it counts as evaluated, so that formulas that use it do not report it again
    hn_rd_param source = {.number = 1, .state = named && value ? 0 : 2};
    if (named && cJSON_IsString(value)) {
        source.formula = hn_rd_keep(r, value->valuestring);
    } else if (named && value) {
        source.number = value->valuedouble;
    }
    add_param(r, &p, &source);
}

static const hn_setting *find_setting(const hn_reader *r, const char *name) {
    for (int i = r->n_settings; i-- > 0;) {
        if (r->settings[i].name && strcmp(r->settings[i].name, name) == 0) {
            return &r->settings[i];
        }
    }
    return NULL;
}

/// "l1 needs l2 needs l1", reported at the parameter where the ring was entered.
static void tell_cycle(hn_reader *r, int k) {
    char ring[HN_DIAG_MESSAGE - 64];
    size_t at = 0;
    int from = 0;
    while (from < r->n_chain && r->chain[from] != k) {
        from++;
    }
    for (int i = from; i < r->n_chain && at + HN_RD_MAX_NAME + 16 < sizeof ring; i++) {
        at += (size_t)snprintf(ring + at, sizeof ring - at, "%s needs ",
                               r->scene->params[r->chain[i]].name);
    }
    char path[sizeof r->path];
    memcpy(path, r->path, sizeof path);
    r->path[0] = '\0';
    hn_rd_enter(r, "parameters");
    hn_rd_enter(r, r->scene->params[k].name);
    hn_rd_fault(r, "give one of them a number", "parameters depend on each other in a ring: %s%s",
                ring, r->scene->params[k].name);
    memcpy(r->path, path, sizeof path);
}

bool hn_rd_param_value(hn_reader *r, int k, double *value) {
    hn_param *p = &r->scene->params[k];
    hn_rd_param *src = &r->param_src[k];
    const hn_setting *set = r->use_settings ? find_setting(r, p->name) : NULL;
    int walk = r->mark_structural && !p->structural && !set && src->formula && src->state == 2;
    p->structural |= r->mark_structural;

    // met again before its own evaluation has ended: a ring
    if (src->state == 1) {
        tell_cycle(r, k);
        src->state = 2;
        p->value = 1;
        return false;
    }

    // evaluated at its own place in the file, outside of any repetition
    if (src->state == 0 || walk) {
        src->state = 1;
        r->chain[r->n_chain++] = k;
        hn_quantity q = {.value = set ? set->value : src->number};
        // a formula written inside a repetition must not see its name
        const char *loop = r->loop_name;
        r->loop_name = NULL;
        char path[sizeof r->path];
        memcpy(path, r->path, sizeof path);
        snprintf(r->path, sizeof r->path, "/parameters");
        hn_rd_enter(r, p->name);
        bool ok = set || !src->formula || hn_rd_formula(r, src->formula, HN_RD_CONST, &q);
        memcpy(r->path, path, sizeof path);
        r->loop_name = loop;
        r->n_chain--;
        p->value = ok ? q.value : 1;
        p->formula = set ? NULL : src->formula;
        src->state = 2;
    }
    *value = p->value;
    return true;
}

static void evaluate_all(hn_reader *r) {
    double ignored;
    for (int k = 0; k < r->scene->n_params && !hn_rd_stopped(r); k++) {
        hn_rd_param_value(r, k, &ignored);
    }
}

static bool is_set(const hn_reader *r, const hn_param *p) {
    for (int i = 0; i < r->n_settings; i++) {
        if (r->settings[i].name && strcmp(r->settings[i].name, p->name) == 0) {
            return true;
        }
    }
    return false;
}

/// Returns whether the sign of a value is none of those in the range: a mass that is 0, a length
/// below 0.
static bool has_other_sign(const hn_param *p) {
    const bool below = (p->min > 0 && p->value <= 0) || (p->min == 0 && p->value < 0);
    const bool above = (p->max < 0 && p->value >= 0) || (p->max == 0 && p->value > 0);
    return below || above;
}

static const char *needed_sign(const hn_param *p) {
    return p->min > 0    ? "above 0"
           : p->max < 0  ? "below 0"
           : p->min == 0 ? "0 or more"
                         : "0 or less";
}

/// Returns whether a value outside the range is of the same kind as those inside: of their sign,
/// and no count. Ranges are those of sliders, not limits of mechanics.
static bool is_possible(const hn_param *p) {
    return !p->integer && !p->structural && !has_other_sign(p);
}

static void check_range(hn_reader *r, const cJSON *node, hn_param *p) {
    hn_quantity q;
    if (hn_rd_member(r, node, "min", 0, -HUGE_VAL, &q, HN_RD_CONST)) {
        p->min = q.value;
    }
    if (hn_rd_member(r, node, "max", 0, HUGE_VAL, &q, HN_RD_CONST)) {
        p->max = q.value;
    }
    if (p->min > p->max) {
        const int digits = hn_digits_apart(p->min, p->max, LEAST_DIGITS);
        hn_rd_fault_at(r, "min", NULL, "min %.*g is larger than max %.*g", digits, p->min, digits,
                       p->max);
    } else if (!isfinite(p->value)) {
        hn_rd_fault(r, NULL, "%s must be a finite number", p->name);
    } else if (fabs(p->value) > HN_SCENE_MAX_NUMBER) {
        hn_rd_fault(r, NULL, "%s = %g is too large to be computed with: 1e100 is the most", p->name,
                    p->value);
    } else if ((p->value < p->min || p->value > p->max) && is_set(r, p) && is_possible(p)) {
        p->beyond = true;
    } else if (has_other_sign(p)) {
        char usual[HN_DIAG_HINT] = "";
        if (isfinite(p->min) && isfinite(p->max)) {
            snprintf(usual, sizeof usual, "%.40s is usually %g to %g%s%.40s", p->name, p->min,
                     p->max, p->unit[0] ? " " : "", p->unit);
        }
        hn_rd_fault(r, usual, "%s = %g%s%s must be %s", p->name, p->value, p->unit[0] ? " " : "",
                    p->unit, needed_sign(p));
    } else if (p->value < p->min || p->value > p->max) {
        const double limit = p->value < p->min ? p->min : p->max;
        const int digits = hn_digits_apart(p->value, limit, LEAST_DIGITS);
        hn_rd_fault(r, NULL, "%s = %.*g is outside its range %.*g ... %.*g %s", p->name, digits,
                    p->value, digits, p->min, digits, p->max, p->unit);
    } else if (p->integer && p->value != floor(p->value)) {
        hn_rd_fault(r, NULL, "%s = %.*g must be a whole number", p->name,
                    hn_digits_apart(p->value, round(p->value), LEAST_DIGITS), p->value);
    }
}

static void check_settings(hn_reader *r) {
    const char *names[HN_SCENE_MAX_PARAMS];
    for (int i = 0; i < r->scene->n_params; i++) {
        names[i] = r->scene->params[i].name;
    }
    for (int i = 0; i < r->n_settings; i++) {
        const char *name = r->settings[i].name ? r->settings[i].name : "";
        if (!hn_scene_start_name(name) && hn_scene_find_param(r->scene, name) < 0) {
            char hint[HN_DIAG_HINT];
            hn_rd_suggest(hint, sizeof hint, name, names, r->scene->n_params);
            hn_rd_fault_at(r, name, hint, "this scene has no parameter '%.60s'", name);
        }
    }
}

void hn_rd_params(hn_reader *r, const cJSON *root) {
    const cJSON *node = hn_rd_get(root, "parameters");
    size_t mark = hn_rd_enter(r, "parameters");
    if (node && !cJSON_IsObject(node)) {
        hn_rd_fault(r, "as in {\"l1\": {\"value\": 1, \"unit\": \"m\"}}",
                    "expected an object, found %s", hn_rd_kind(node));
        node = NULL;
    }
    int index = 0;
    for (const cJSON *m = node ? node->child : NULL; m && !hn_rd_stopped(r); m = m->next) {
        size_t inner = hn_rd_enter(r, m->string);
        read_param(r, m, m->string);
        hn_rd_leave(r, inner);
    }
    check_settings(r);

    // once as the file says, once as set
    evaluate_all(r);
    for (int k = 0; k < r->scene->n_params; k++) {
        r->scene->params[k].initial = r->scene->params[k].value;
    }
    if (r->n_settings > 0 && r->n_faults == 0) {
        for (int k = 0; k < r->scene->n_params; k++) {
            r->param_src[k].state = 0;
        }
        r->use_settings = true;
        evaluate_all(r);
    }
    for (const cJSON *m = node ? node->child : NULL;
         m && index < r->scene->n_params && !hn_rd_stopped(r); m = m->next, index++) {
        size_t inner = hn_rd_enter(r, m->string);
        check_range(r, m, &r->scene->params[index]);
        hn_rd_leave(r, inner);
    }
    hn_rd_leave(r, mark);
}
