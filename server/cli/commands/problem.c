// SPDX-License-Identifier: GPL-3.0-or-later
// holonom problem: an exercise with its numbers, its hints, or the proof that it is sound.
#include "cli/commands/exercise_word.h"
#include "cli/commands/rubric_file.h"
#include "cli/shell/commands.h"
#include "cli/shell/diagnostics.h"
#include "cli/shell/forms.h"
#include "cli/shell/output_file.h"
#include "cli/shell/print.h"
#include "grade/exercise_check.h"
#include "grade/exercise_text.h"
#include "grade/rubric_apply.h"
#include "grade/variant_text.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { DEFAULT_SEEDS = 20 };

/// "1..200"; 0 when it is none.
static int read_seeds(const char *text, uint64_t *from, uint64_t *to) {
    unsigned long long a, b;
    int used = 0;
    *from = 1;
    *to = DEFAULT_SEEDS;
    if (!text) {
        return 1;
    }
    if (sscanf(text, "%llu..%llu%n", &a, &b, &used) != 2 || text[used] || a < 1 || b < a) {
        return 0;
    }
    *from = a;
    *to = b;
    return 1;
}

/// The draws that a condition refused, and how far apart right answers are.
static void put_spread(hn_strbuf *b, const hn_exercise *e, const hn_exercise_report *r) {
    const cJSON *conditions = cJSON_GetObjectItemCaseSensitive(e->root, "conditions");
    for (int k = 0; k < HN_DRAW_CONDITIONS; k++) {
        const char *condition = cJSON_GetStringValue(cJSON_GetArrayItem(conditions, k));
        if (condition && r->refused[k] > 0) {
            hn_strbuf_printf(b, "  drawn again %lld time%s, for not %s > 0\n", r->refused[k],
                             r->refused[k] == 1 ? "" : "s", condition);
        }
    }
    for (int i = 0; i < e->n_parts; i++) {
        const hn_answer_spread *s = &r->spread[i];
        const char *unit = hn_part_text(e->parts[i].node, "unit");
        if (s->n > 0) {
            hn_strbuf_printf(b, "  right answers of part %s: %.6g to %.6g%s%s\n", e->parts[i].id,
                             s->low, s->high, *unit ? " " : "", unit);
        }
    }
    if (!e->n_parts) {
        hn_strbuf_add(b, "  right answers: the same formulas for all; the numbers to try them on "
                         "differ\n");
    }
}

static bool is_choice(const hn_part *p) {
    return strcmp(hn_part_text(p->node, "kind"), "choice") == 0;
}

/// How well both means of each reference agree, and how a reference without two numbers is proved.
static void put_agreement(hn_strbuf *b, const hn_exercise *e, const hn_exercise_report *r) {
    if (!e->n_parts && r->spread[0].measured > 0) {
        hn_strbuf_printf(b,
                         "  both means of %s, the derivative and a central difference of phi, "
                         "agree to %.2g of an entry's size at worst\n",
                         e->answer, r->spread[0].apart);
    }
    for (int i = 0; i < e->n_parts; i++) {
        const hn_part *p = &e->parts[i];
        if (r->spread[i].measured > 0 && r->spread[i].apart == 0) {
            hn_strbuf_printf(b, "  both means of part %s agree in every digit\n", p->id);
        } else if (r->spread[i].measured > 0) {
            hn_strbuf_printf(b, "  both means of part %s agree to %.2g of the value at worst\n",
                             p->id, r->spread[i].apart);
        } else if (r->rights > 0) {
            hn_strbuf_printf(b, "  part %s (%s): %s; no difference to measure\n", p->id,
                             hn_part_text(p->node, "kind"),
                             is_choice(p) ? "the author marks the right option, and every wrong "
                                            "one says why"
                             : p->kind->prove ? "the test of its kind confirms the reference"
                                              : "the reference is graded like an answer");
        }
    }
}

/// Returns whether a mechanism is assembled, drawn or moved.
static bool has_mechanism(const hn_exercise *e) {
    bool has = !e->n_parts || cJSON_GetObjectItemCaseSensitive(e->root, "picture") != NULL;
    for (int i = 0; i < e->n_parts; i++) {
        has |= cJSON_GetObjectItemCaseSensitive(e->parts[i].node, "scene") != NULL;
    }
    return has;
}

/// The same of each part as members; of a matrix of formulas under its name.
static void put_parts(hn_strbuf *b, const hn_exercise *e, const hn_exercise_report *r) {
    hn_json_key(b, "parts");
    hn_json_object(b);
    for (int i = 0; i < (e->n_parts ? e->n_parts : 1); i++) {
        const hn_answer_spread *s = &r->spread[i];
        hn_json_key(b, e->n_parts ? e->parts[i].id : e->answer);
        hn_json_object(b);
        if (s->n > 0) {
            hn_json_put_number(b, "least", s->low);
            hn_json_put_number(b, "largest", s->high);
        }
        if (s->measured > 0) {
            hn_json_put_number(b, "worst_difference", s->apart);
        }
        hn_json_end_object(b);
    }
    hn_json_end_object(b);
}

static void put_report(hn_strbuf *b, const hn_exercise *e, const hn_exercise_report *r, int json) {
    if (json) {
        hn_json_object(b);
        hn_json_put_string(b, "id", hn_exercise_id(e));
        hn_json_put_int(b, "variants", r->variants);
        hn_json_put_int(b, "bad", r->bad);
        hn_json_put_int(b, "distinct", r->distinct);
        hn_json_put_int(b, "right_answers", r->rights);
        hn_json_put_int(b, "mistakes", r->faults);
        hn_json_put_string(b, "first_fault", r->first);
        hn_json_put_string(b, "bad_variants", r->list);
        put_parts(b, e, r);
        hn_json_end_object(b);
        return;
    }
    hn_strbuf_printf(b,
                     "%s: %lld variants, %lld distinct; %lld right answers and %lld mistakes "
                     "graded; %lld variants are bad\n",
                     hn_exercise_id(e), r->variants, r->distinct, r->rights, r->faults, r->bad);
    long long listed = 0;
    for (const char *at = r->list; *at; at += strcspn(at, "\n") + 1) {
        hn_strbuf_printf(b, "  %.*s\n", (int)strcspn(at, "\n"), at);
        listed++;
    }
    if (listed < r->bad && !r->same) {
        hn_strbuf_printf(b, "  and %lld more\n", r->bad - listed);
    }
    put_spread(b, e, r);
    put_agreement(b, e, r);
    if (has_mechanism(e)) {
        hn_strbuf_add(b, "  not checked: how near a mechanism comes to a singular configuration; "
                         "a condition keeps it away\n");
    }
    hn_rubric_put_mistakes(b, e);
}

/// A fault of the exercise is the program's fault here, not that of the command line.
static hn_exit check(const hn_args *args, const hn_exercise *e) {
    uint64_t from, to;
    hn_diag diag;
    hn_exercise_report report;
    hn_strbuf b;

    // what the command line asks for
    if (!read_seeds(args->seeds, &from, &to)) {
        hn_diag_set(&diag, HN_ERR_INPUT, NULL, "--seeds 1..200", "'%.40s' is no range of seeds",
                    args->seeds);
        return hn_report_diag(args, &diag);
    }
    if (hn_exercise_check(e, from, to, &report) != HN_OK) {
        return HN_EXIT_PROGRAM;
    }
    hn_strbuf_init(&b);
    put_report(&b, e, &report, args->json);
    const hn_exit result = args->json ? hn_cli_print(&b) : hn_cli_print_text(&b);
    return report.bad ? HN_EXIT_PROGRAM : result;
}

/// Refuses options that would say nothing here, and hints that are not there.
static hn_status check_options(const hn_args *args, const hn_exercise *e, hn_diags *diags) {
    const bool variant = args->student || !isnan(args->seed);
    const struct {
        bool given;
        const char *pointer, *says, *hint;
    } rows[] = {
        {args->seeds && !args->check, "/seeds", "--seeds is for --check", "add --check"},
        {args->check && variant, "/seed", "--check tries a range of variants, not one",
         "--seeds A..B in the place of --seed and --student"},
        {args->check && args->hint > 0, "/hint", "--check prints no hints", "leave --hint out"},
        {args->check && args->out, "/out", "--check writes no file", "leave --out out"},
        {args->out && args->hint > 0, "/out", "hints are not written to a file",
         "leave --out or --hint out"},
        {args->out && !e->n_parts, "/out", "no part of this exercise asks about a plot",
         "leave --out out"},
        {args->out && args->json, "/json", "--out writes plots; it has no JSON",
         "leave --out or --json out"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (rows[i].given) {
            return hn_diags_add(diags, HN_ERR_INPUT, rows[i].pointer, rows[i].hint, "%s",
                                rows[i].says);
        }
    }
    if (!isnan(args->hint) && (args->hint < 1 || args->hint > e->n_hints)) {
        return hn_diags_add(diags, HN_ERR_INPUT, "/hint", "--hint N prints the first N",
                            "exercise %.60s has %d hint%s; --hint is %.0f", e->id, e->n_hints,
                            e->n_hints == 1 ? "" : "s", args->hint);
    }
    return hn_cli_check_student(args, diags);
}

static hn_exit print_hints(const hn_args *args, const hn_exercise *e, hn_variant *x) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    for (int i = 0; i < e->n_hints && i < args->hint; i++) {
        hn_strbuf_printf(&b, "hint %d of %d: ", i + 1, e->n_hints);
        hn_draw_text(&b, &x->draw, e->hints[i]);
        hn_strbuf_add(&b, "\n");
    }
    return hn_cli_print_prose(&b);
}

/// The figures of an exercise: parts that ask about the same plot share one.
typedef struct figures {
    int n;
    hn_strbuf svg[HN_GRADE_MAX_PARTS];
    char parts[HN_GRADE_MAX_PARTS][64]; ///< "a and b"
    char ids[HN_GRADE_MAX_PARTS][64];   ///< "ab"
} figures;

static void add_words(char out[64], const char *between, const char *word) {
    const size_t used = strlen(out);
    snprintf(out + used, 64 - used, "%s%s", used ? between : "", word);
}

static void draw_figures(const hn_variant *x, figures *f) {
    for (int i = 0; i < x->n_parts; i++) {
        const hn_part *part = &x->part[i];
        hn_strbuf *svg = &f->svg[f->n];
        int same = 0;
        if (!part->kind->figure) {
            continue;
        }
        hn_strbuf_init(svg);
        part->kind->figure(svg, part, HN_FIGURE_FILE);
        while (same < f->n && strcmp(hn_strbuf_text(&f->svg[same]), hn_strbuf_text(svg)) != 0) {
            same++;
        }
        add_words(f->parts[same], " and ", part->id);
        add_words(f->ids[same], "", part->id);
        if (same < f->n) {
            hn_strbuf_reset(svg);
        } else {
            f->n++;
        }
    }
}

/// Writes the figures of all parts that have one: into FILE.svg, or with the ids of the parts
/// before the ending where there are several.
static hn_exit write_figures(const hn_args *args, const hn_exercise *e, const hn_variant *x) {
    hn_diag diag;
    hn_exit result = HN_EXIT_DONE;
    figures f = {0};
    draw_figures(x, &f);
    if (f.n == 0 || !hn_path_ends_in(args->out, ".svg")) {
        hn_diag_set(&diag, HN_ERR_INPUT, "/out",
                    f.n ? "end it in .svg" : "'holonom snapshot ID -o FILE' draws its mechanism",
                    f.n ? "'%.200s' is no name for a plot" : "no part of '%.80s' asks about a plot",
                    f.n ? args->out : hn_exercise_id(e));
        result = hn_report_diag(args, &diag);
    }
    for (int i = 0; i < f.n; i++) {
        hn_strbuf path;
        hn_strbuf_init(&path);
        if (result == HN_EXIT_DONE) {
            hn_strbuf_add_n(&path, args->out, strlen(args->out) - 4);
            hn_strbuf_printf(&path, f.n > 1 ? "-%s.svg" : ".svg", f.ids[i]);
            result = hn_cli_write_picture(args, hn_strbuf_text(&path), &f.svg[i]);
        }
        if (result == HN_EXIT_DONE) {
            printf("the plot of part%s %s: %s\n", strlen(f.ids[i]) > 1 ? "s" : "", f.parts[i],
                   hn_strbuf_text(&path));
        }
        hn_strbuf_reset(&path);
        hn_strbuf_reset(&f.svg[i]);
    }
    return result;
}

static hn_exit print_variant(const hn_args *args, const hn_exercise *e) {
    hn_variant x;
    hn_diag diag = {0};

    // the variant of this student, or of the seed given
    const uint64_t seed = hn_cli_variant_seed(args, e);
    const hn_status status = hn_variant_init(&x, e, seed, &diag);
    x.student = args->student;

    hn_exit result = HN_EXIT_PROGRAM;
    hn_strbuf b;
    hn_strbuf_init(&b);
    if (status != HN_OK) {
        hn_diag where;
        hn_diag_set(&where, status, diag.pointer, diag.hint, "line %d: %s",
                    hn_exercise_line(e, -1, diag.pointer), diag.message);
        hn_report_diag(args, &where);
    } else if (args->out) {
        result = write_figures(args, e, &x);
    } else if (args->hint > 0) {
        result = print_hints(args, e, &x);
    } else if (args->json) {
        hn_variant_json(&b, &x);
        result = hn_cli_print(&b);
    } else {
        hn_variant_text(&b, &x);
        result = hn_cli_print_prose(&b);
    }
    hn_variant_reset(&x);
    return result;
}

static hn_exit print_matrix_exercise(const hn_args *args, const hn_exercise *e) {
    hn_strbuf b;
    hn_strbuf_init(&b);
    const uint64_t seed = hn_cli_variant_seed(args, e);
    if (args->json) {
        hn_exercise_json(&b, e, seed, args->student);
    } else {
        hn_exercise_text(&b, e, seed, args->student);
    }
    return args->json ? hn_cli_print(&b) : hn_cli_print_prose(&b);
}

hn_exit hn_command_problem(const hn_library *lib, const hn_args *args) {
    hn_exercise *e = NULL;
    hn_diags diags = {0};
    const hn_status status = hn_cli_load_exercise(lib, args->words.word[0], &e, &diags);
    if (status != HN_OK) {
        const hn_exit result = hn_report_diags(args, status, &diags);
        return hn_cli_is_exercise(lib, args->words.word[0]) ? HN_EXIT_PROGRAM : result;
    }
    if (check_options(args, e, &diags) != HN_OK) {
        hn_exercise_free(e);
        return hn_report_diags(args, HN_ERR_INPUT, &diags);
    }

    // the points and tolerances by which the answer will be graded
    const hn_status fits = hn_cli_apply_rubric(args, e, &diags);
    if (fits != HN_OK) {
        hn_exercise_free(e);
        return hn_report_diags(args, fits, &diags);
    }
    const hn_exit result = args->check  ? check(args, e)
                           : e->n_parts ? print_variant(args, e)
                                        : print_matrix_exercise(args, e);
    hn_exercise_free(e);
    return result;
}
