// SPDX-License-Identifier: GPL-3.0-or-later
// holonom inspect, equations, terms: questions about one scene.
#include "cli/commands/inspect_words.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/document.h"
#include "cli/shell/print.h"
#include "cli/shell/scene_word.h"
#include "session/model/equations.h"
#include "session/model/inspect_json.h"
#include "session/model/native_costs.h"
#include "session/model/terms_json.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/// Adds the member "native" to the finished object in `b`: measured here, so no part of the facts
/// that the model states.
static void add_native(hn_strbuf *b, const hn_model *model) {
    hn_strbuf costs;
    hn_strbuf_init(&costs);
    hn_model_native_put(&costs, model);
    HN_ASSERT(b->failed || (b->n > 2 && b->text[b->n - 1] == '}'));
    if (!b->failed) {
        b->n--;
        hn_strbuf_printf(b, ",\"native\":%s}", hn_strbuf_text(&costs));
    }
    b->failed |= costs.failed;
    hn_strbuf_reset(&costs);
}

hn_exit hn_command_inspect(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = hn_args_load_model(lib, args, args->words.word[0], 1, &model, &diags);
    HN_THEN(status, hn_model_inspect_json(&b, model, &diags));
    if (status == HN_OK) {
        add_native(&b, model);
    }
    const int assembled = status == HN_OK && hn_model_assembly(model)->ok;
    hn_model_free(model);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }

    // the document, or its outline for people; a scene that cannot be assembled is at fault
    if (args->json) {
        const hn_exit printed = hn_cli_print(&b);
        return printed == HN_EXIT_DONE && !assembled ? HN_EXIT_INPUT : printed;
    }
    cJSON *document = hn_document_parse(&b);
    hn_document_outline(&b, document, hn_inspect_words);
    b.failed |= document == NULL;
    cJSON_Delete(document);
    const hn_exit printed = hn_cli_print_text(&b);
    return printed == HN_EXIT_DONE && !assembled ? HN_EXIT_INPUT : printed;
}

static hn_status choose_form(const hn_args *args, hn_equation_form *form, hn_diags *diags) {
    static const char *const names[] = {"text", "latex", "json"};
    static const hn_equation_form forms[] = {HN_EQUATIONS_TEXT, HN_EQUATIONS_LATEX,
                                             HN_EQUATIONS_JSON};
    *form = args->json ? HN_EQUATIONS_JSON : HN_EQUATIONS_TEXT;
    if (!args->format) {
        return HN_OK;
    }
    for (int i = 0; i < 3; i++) {
        if (strcmp(args->format, names[i]) == 0) {
            *form = forms[i];
            return HN_OK;
        }
    }
    return hn_diags_add(diags, HN_ERR_INPUT, NULL, "text, latex or json",
                        "'%.40s' is not a form of equations", args->format);
}

hn_exit hn_command_equations(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_equation_form form;
    hn_strbuf b;
    hn_strbuf_init(&b);
    hn_status status = choose_form(args, &form, &diags);
    HN_THEN(status, hn_args_load_model(lib, args, args->words.word[0], 1, &model, &diags));
    HN_THEN(status, hn_model_equations(&b, model, form, &diags));
    hn_model_free(model);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }
    return form == HN_EQUATIONS_TEXT ? hn_cli_print_text(&b) : hn_cli_print(&b);
}

enum { MAX_ENTRIES = 400 };

typedef struct state {
    int n;
    hn_state_entry entries[MAX_ENTRIES];
    char names[MAX_ENTRIES][64];
} state;

static hn_status see_entry(void *user, const char *name, double value) {
    state *s = user;
    if (s->n == MAX_ENTRIES) {
        return HN_ERR_LIMIT;
    }
    snprintf(s->names[s->n], sizeof s->names[s->n], "%s", name);
    s->entries[s->n] = (hn_state_entry){.name = s->names[s->n], .value = value};
    s->n++;
    return HN_OK;
}

/// An entry this share of the largest in its vector is rounding: some tens of units in the last
/// place.
static const double ROUNDING = 1e-14;

/// Writes a vector, one row an entry; what is rounding beside its largest entry is shown as 0.
static void put_vector(hn_strbuf *b, const char *title, const cJSON *document, const char *key,
                       const cJSON *names) {
    const cJSON *values = hn_document_get(document, key);
    cJSON *shown = cJSON_Duplicate(values, true), *number;
    double largest = 0;
    cJSON_ArrayForEach(number, shown) {
        largest = fmax(largest, fabs(cJSON_GetNumberValue(number)));
    }
    cJSON_ArrayForEach(number, shown) {
        if (fabs(cJSON_GetNumberValue(number)) <= ROUNDING * largest) {
            cJSON_SetNumberValue(number, 0);
        }
    }
    if (cJSON_GetArraySize(shown) > 0) {
        hn_document_matrix(b, title, shown, names, NULL);
    }
    cJSON_Delete(shown);
}

/// Largest entry of `key` in the list.
static double largest_of(const cJSON *list, const char *key) {
    const cJSON *item, *number;
    double largest = 0;
    cJSON_ArrayForEach(item, list) {
        cJSON_ArrayForEach(number, hn_document_get(item, key)) {
            largest = fmax(largest, fabs(cJSON_GetNumberValue(number)));
        }
    }
    return largest;
}

/// Force and moment of each, in world axes; a star where redundant rows leave it undetermined. What
/// is rounding beside the largest is shown as 0.
static void put_reactions(hn_strbuf *b, const cJSON *list) {
    static const char *const keys[] = {"force", "moment"};
    const cJSON *item;
    if (cJSON_GetArraySize(list) == 0) {
        return;
    }

    // numbers that are rounding beside the largest are shown as 0
    const double force = largest_of(list, "force"), moment = largest_of(list, "moment");
    const double rounding[] = {1e-12 * force, 1e-12 * fmax(force, moment)};
    hn_strbuf_add(b, "reactions on the body that is named, in world axes; those of a joint contain "
                     "the drives and loads along its coordinates\n");
    cJSON_ArrayForEach(item, list) {
        hn_strbuf_printf(b, "  %-16s on %-12s", hn_document_text(item, "name"),
                         hn_document_text(item, "on"));
        for (int k = 0; k < 2; k++) {
            const cJSON *part = hn_document_get(item, keys[k]), *number;
            hn_strbuf_add(b, k ? "  moment" : "  force");
            cJSON_ArrayForEach(number, part) {
                const double x = cJSON_GetNumberValue(number);
                hn_strbuf_printf(b, " %12.6g", fabs(x) > rounding[k] ? x : 0);
            }
            hn_strbuf_add(b, k ? " N m" : " N");
        }
        hn_strbuf_add(b, cJSON_IsTrue(hn_document_get(item, "determined"))
                             ? "\n"
                             : "  * one of many: rows are redundant\n");
    }
}

/// Writes what acts along coordinates, and at no place.
static void put_efforts(hn_strbuf *b, const cJSON *list) {
    const cJSON *item;
    if (cJSON_GetArraySize(list) > 0) {
        hn_strbuf_add(b, "efforts along coordinates\n");
    }
    cJSON_ArrayForEach(item, list) {
        hn_strbuf_printf(b, "  %-16s  along %-12s %12.6g %s%s\n", hn_document_text(item, "name"),
                         hn_document_text(item, "coordinate"), hn_document_number(item, "value"),
                         hn_document_text(item, "unit"),
                         cJSON_IsTrue(hn_document_get(item, "determined"))
                             ? ""
                             : "  * one of many: rows are redundant");
    }
}

/// The equations left on the free motion, or why there are none.
static void put_reduced(hn_strbuf *b, const cJSON *d, const cJSON *names) {
    static const struct {
        const char *title, *key;
        int matrix;
    } parts[] = {{"M_r = Phi' M Phi", "M_r", 1},
                 {"C_r, so that M_r' - 2 C_r is skew", "C_r", 1},
                 {"v_r", "v_r", 0},
                 {"d_r, from closures that depend on time", "d_r", 0},
                 {"g_r = Phi' g, gravity and springs", "g_r", 0},
                 {"tau_r = Phi' tau, motors and other loads", "tau_r", 0},
                 {"a_r", "a_r", 0}};

    // the choice of coordinates, and why there is none
    const cJSON *independent = hn_document_get(d, "independent"), *name;
    if (!cJSON_IsTrue(hn_document_get(d, "exists"))) {
        hn_strbuf_printf(b, "reduced coordinates: none here: %s\n", hn_document_text(d, "why"));
        return;
    }
    hn_strbuf_printf(b, "reduced coordinates: %s\nindependent:", hn_document_text(d, "equations"));
    cJSON_ArrayForEach(name, independent) {
        hn_strbuf_printf(b, "%s %s", name == independent->child ? "" : ",", name->valuestring);
    }
    hn_strbuf_printf(b, " (%s)\n", hn_document_text(d, "chosen_by"));
    const double gap = hn_document_number(d, "speed_gap");
    if (!isnan(gap)) {
        hn_strbuf_printf(b,
                         "the given velocities violate the closed loops by %.3g; below, the "
                         "dependent velocities are computed from v_r\n",
                         gap);
    }
    if (cJSON_GetArraySize(independent) == 0) {
        return;
    }

    // matrices and vectors in these coordinates
    hn_document_matrix(b, "Phi, v = Phi v_r", hn_document_get(d, "Phi"), names, independent);
    put_vector(b, "s, velocities at v_r = 0", d, "s", names);
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        if (parts[i].matrix) {
            hn_document_matrix(b, parts[i].title, hn_document_get(d, parts[i].key), independent,
                               independent);
        } else {
            put_vector(b, parts[i].title, d, parts[i].key, independent);
        }
    }
}

/// Writes what the multipliers are worth, where that is not all their digits.
static void put_mark(hn_strbuf *b, const cJSON *d) {
    const char *mark = hn_document_text(d, "lambda_mark");
    if (mark[0] && strcmp(mark, "determined") != 0) {
        hn_strbuf_printf(
            b,
            "multipliers, and reactions computed from them: %s (condition %.2g, rank %g of %d)\n",
            mark, hn_document_number(d, "condition"), hn_document_number(d, "rank"),
            cJSON_GetArraySize(hn_document_get(d, "rows")));
    }
}

/// "four-bar at its start": of a state, its time is only that of formulas.
static void put_terms_heading(hn_strbuf *b, const cJSON *d, const hn_args *args) {
    const bool given = args->state_q.n > 0 || args->state_v.n > 0;
    hn_strbuf_printf(b, "%s %s", hn_document_text(d, "scene"),
                     given ? "at its start, changed by --q and --v" : "at its start");
    if (!isnan(args->t)) {
        hn_strbuf_printf(b, ", with t = %g s in the formulas that depend on time",
                         hn_document_number(d, "t"));
    }
    hn_strbuf_printf(b, ": %s\n", hn_document_text(d, "equations"));
    if (!isnan(args->t) && !given) {
        hn_strbuf_printf(b,
                         "--t does not move the mechanism; for the motion at that time: holonom "
                         "run %s --at %g --reactions\n",
                         args->words.word[0], hn_document_number(d, "t"));
    }
}

static void put_terms(hn_strbuf *b, const cJSON *d, const hn_args *args) {
    static const struct {
        const char *title, *key;
        int matrix, by_row; // 2: rows are the velocities
    } parts[] = {{"q, coordinates", "q", 0, 0},
                 {"v, velocities, to which M, f, J and a belong", "v", 0, 2},
                 {"M, mass matrix of the velocities v", "M", 1, 2},
                 {"f = Q - h, forces", "f", 0, 0},
                 {"J, Jacobian of the loops", "J", 1, 1},
                 {"gamma = Jdot v", "gamma", 0, 1},
                 {"phi, gap of the loops", "phi", 0, 1},
                 {"a, accelerations", "a", 0, 0},
                 {"lambda, multipliers", "lambda", 0, 1}};
    const cJSON *names = hn_document_get(d, "coordinates"), *rows = hn_document_get(d, "rows");
    const cJSON *rates = hn_document_get(d, "rates");
    put_terms_heading(b, d, args);

    // matrices where they have rows, vectors always
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        const cJSON *row_names[] = {names, rows, rates};
        const cJSON *own = row_names[parts[i].by_row];
        if (parts[i].matrix && cJSON_GetArraySize(hn_document_get(d, parts[i].key)) > 0) {
            hn_document_matrix(b, parts[i].title, hn_document_get(d, parts[i].key), own, rates);
        } else if (!parts[i].matrix) {
            put_vector(b, parts[i].title, d, parts[i].key, own);
        }
    }
    put_reduced(b, hn_document_get(d, "reduced"), names);
    put_reactions(b, hn_document_get(d, "reactions"));
    put_efforts(b, hn_document_get(d, "efforts"));
    put_mark(b, d);
    hn_strbuf_printf(b, "rank %g, gap %.3g, velocity gap %.3g, energy %.9g J\n",
                     hn_document_number(d, "rank"), hn_document_number(d, "gap"),
                     hn_document_number(d, "velocity_gap"),
                     hn_document_number(d, "kinetic") + hn_document_number(d, "potential"));
}

hn_exit hn_command_terms(const hn_library *lib, const hn_args *args) {
    hn_model *model = NULL;
    hn_diags diags = {0};
    hn_strbuf b;
    hn_strbuf_init(&b);
    state *s = calloc(1, sizeof *s);
    hn_status status =
        s ? hn_assignments_read(&args->state_q, "--q", see_entry, s, &diags) : HN_ERR_MEMORY;
    HN_THEN(status, hn_assignments_read(&args->state_v, "--v", see_entry, s, &diags));
    HN_THEN(status, hn_args_load_model(lib, args, args->words.word[0], 0, &model, &diags));

    // the terms at that state
    if (status == HN_OK) {
        const double t = isnan(args->t) ? 0 : args->t;
        status = args->reactions
                     ? hn_model_terms_json_with_reactions(&b, model, t, s->entries, s->n, &diags)
                     : hn_model_terms_json(&b, model, t, s->entries, s->n, &diags);
    }
    hn_model_free(model);
    free(s);
    if (status != HN_OK) {
        hn_strbuf_reset(&b);
        return hn_report_diags(args, status, &diags);
    }

    // the document, or tables for people
    if (args->json) {
        return hn_cli_print(&b);
    }
    cJSON *document = hn_document_parse(&b);
    put_terms(&b, document, args);
    b.failed |= document == NULL;
    cJSON_Delete(document);
    return hn_cli_print_text(&b);
}
