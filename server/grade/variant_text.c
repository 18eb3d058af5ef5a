// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/variant_text.h"

#include "base/hash.h"
#include "base/paragraphs.h"
#include "grade/exercise_text.h"

#include <stdio.h>
#include <string.h>

static void put_statement(hn_strbuf *b, hn_variant *x, const hn_part *p) {
    (void)p;
    const cJSON *line;
    cJSON_ArrayForEach(line, cJSON_GetObjectItemCaseSensitive(x->exercise->root, "statement")) {
        hn_draw_text(b, &x->draw, cJSON_IsString(line) ? line->valuestring : "");
        hn_strbuf_add(b, "\n");
    }
}

static void put_question(hn_strbuf *b, hn_variant *x, const hn_part *p) {
    const cJSON *ask = cJSON_GetObjectItemCaseSensitive(p->node, "ask"), *line;
    if (cJSON_IsString(ask)) {
        hn_draw_text(b, &x->draw, ask->valuestring);
    }
    const cJSON *lines = cJSON_IsArray(ask) ? ask : NULL;
    cJSON_ArrayForEach(line, lines) {
        hn_draw_text(b, &x->draw, cJSON_IsString(line) ? line->valuestring : "");
        hn_strbuf_add(b, line->next ? "\n" : "");
    }
}

/// Writes what `put` writes, as paragraphs for a reader of any width.
static void put_joined(hn_strbuf *b, hn_variant *x, const hn_part *p,
                       void (*put)(hn_strbuf *b, hn_variant *x, const hn_part *p)) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    put(&text, x, p);
    hn_paragraphs_join(b, hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

/// The member that says which variant is answered; nothing for the exercise's own.
static void put_variant(hn_strbuf *b, const hn_variant *x) {
    if (x->student) {
        hn_strbuf name;
        hn_strbuf_init(&name);
        hn_json_string(&name, x->student);
        hn_strbuf_printf(b, "\"student\": %s, ", hn_strbuf_text(&name));
        b->failed |= name.failed;
        hn_strbuf_reset(&name);
    } else if (x->chosen) {
        hn_strbuf_printf(b, "\"seed\": %llu, ", (unsigned long long)x->seed);
    }
}

void hn_variant_notation(hn_strbuf *b, const hn_variant *x) {
    static const struct {
        const char *kinds[4], *says;
    } NOTATIONS[] = {
        {{"formula", "formulas", "basis"},
         "Formulas: a*b or a b, a^2, a/b, sin(th1), sqrt(x), pi; angles in radians; theta_1 is "
         "th1, in Greek letters too.\n"},
        {{"formula", "formulas"},
         "Write numbers in formulas by their names, or with 7 digits: a rounded one earns half.\n"},
        {{"matrix", "blocks"},
         "Formulas of matrices: M J or M*J is the product, J' or J^T the transpose, inv(M) the "
         "inverse.\n"},
    };
    for (size_t i = 0; i < sizeof NOTATIONS / sizeof *NOTATIONS; i++) {
        bool used = false;
        for (int k = 0; k < x->n_parts; k++) {
            const char *kind = hn_part_text(x->part[k].node, "kind");
            for (int j = 0; NOTATIONS[i].kinds[j]; j++) {
                used |= strcmp(kind, NOTATIONS[i].kinds[j]) == 0;
            }
        }
        hn_strbuf_add(b, used ? NOTATIONS[i].says : "");
    }
}

/// The shape of the submission, how formulas are written, and where the hints are.
static void put_hand_in(hn_strbuf *b, const hn_variant *x) {
    const hn_exercise *p = x->exercise;
    hn_strbuf_add(b, "\nHand in a JSON file:\n  {");
    put_variant(b, x);
    for (int i = 0; i < x->n_parts; i++) {
        hn_strbuf_printf(b, "%s\"%s\": ...", i ? ", " : "", x->part[i].id);
    }
    hn_strbuf_add(b, "}\n");
    hn_variant_notation(b, x);
    hn_exercise_put_drawn(b, p, "Other variants have other numbers: ", ".\n");
    if (p->n_hints) {
        hn_strbuf_printf(b, "%d hint%s: holonom problem %s --hint 1\n", p->n_hints,
                         p->n_hints == 1 ? "" : "s", p->id);
    }
}

void hn_variant_text(hn_strbuf *b, hn_variant *x) {
    const hn_exercise *p = x->exercise;
    hn_strbuf_printf(b, "Exercise %s: %s (lesson %s, %s; %g point%s; seed %llu)\n\n", p->id,
                     p->title, p->lesson, p->section, hn_exercise_points(p),
                     hn_exercise_points(p) == 1 ? "" : "s", (unsigned long long)x->seed);
    put_joined(b, x, NULL, put_statement);
    for (int i = 0; i < x->n_parts; i++) {
        const hn_part *part = &x->part[i];
        hn_strbuf_printf(b, "\n%s) [%g point%s] ", part->id, part->points,
                         part->points == 1 ? "" : "s");
        put_joined(b, x, part, put_question);
        hn_strbuf_printf(b, "\n  answer \"%s\": ", part->id);
        part->kind->ask(b, part);
        hn_strbuf_add(b, "\n");
        if (part->kind->figure) {
            hn_strbuf_add(b, "\n");
            part->kind->figure(b, part, HN_FIGURE_TEXT);
        }
    }
    put_hand_in(b, x);
}

/// The figure that a part asks about, as text for a terminal and as SVG for a page.
static void put_figure(hn_strbuf *b, const hn_part *part) {
    static const char *const keys[] = {"text", "svg"};
    if (!part->kind->figure) {
        return;
    }
    hn_json_key(b, "figure");
    hn_json_object(b);
    for (int i = 0; i < 2; i++) {
        hn_strbuf figure;
        hn_strbuf_init(&figure);
        part->kind->figure(&figure, part, i == 0 ? HN_FIGURE_TEXT : HN_FIGURE_PAGE);
        hn_json_put_string(b, keys[i], hn_strbuf_text(&figure));
        b->failed |= figure.failed;
        hn_strbuf_reset(&figure);
    }
    hn_json_end_object(b);
}

static void put_part(hn_strbuf *b, hn_variant *x, const hn_part *part) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_json_object(b);
    hn_json_put_string(b, "id", part->id);
    hn_json_put_string(b, "kind", hn_part_text(part->node, "kind"));
    hn_json_put_number(b, "points", part->points);
    put_question(&text, x, part);
    hn_json_put_string(b, "ask", hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_clear(&text);
    part->kind->ask(&text, part);
    hn_json_put_string(b, "answer_form", hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
    put_figure(b, part);
    hn_json_end_object(b);
}

void hn_variant_hint(hn_strbuf *b, hn_variant *x, int number) {
    hn_draw_text(b, &x->draw, x->exercise->hints[number - 1]);
}

/// The text of a submission to fill in.
static void put_submission(hn_strbuf *b, const hn_variant *x) {
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_strbuf_add(&text, "{");
    put_variant(&text, x);
    for (int i = 0; i < x->n_parts; i++) {
        cJSON *blank = x->part[i].kind->blank(&x->part[i]);
        char *printed = cJSON_PrintUnformatted(blank);
        hn_strbuf_printf(&text, "%s\"%s\": %s", i ? ", " : "", x->part[i].id,
                         printed ? printed : "");
        text.failed |= !printed;
        cJSON_free(printed);
        cJSON_Delete(blank);
    }
    hn_strbuf_add(&text, "}");
    hn_json_put_string(b, "submission", hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);
}

void hn_variant_json(hn_strbuf *b, hn_variant *x) {
    const hn_exercise *p = x->exercise;
    char hash[17], seed[32];
    hn_strbuf text;
    hn_strbuf_init(&text);
    hn_hash_hex(p->hash, hash);
    snprintf(seed, sizeof seed, "%llu", (unsigned long long)x->seed);
    hn_json_object(b);
    hn_exercise_put_names(b, p);
    hn_json_put_number(b, "points", hn_exercise_points(p));
    hn_json_put_string(b, "hash", hash);
    hn_json_put_string(b, "seed", seed);
    put_statement(&text, x, NULL);
    hn_json_put_string(b, "statement", hn_strbuf_text(&text));
    b->failed |= text.failed;
    hn_strbuf_reset(&text);

    // the parts, and the numbers that were drawn
    hn_json_key(b, "parts");
    hn_json_array(b);
    for (int i = 0; i < x->n_parts; i++) {
        put_part(b, x, &x->part[i]);
    }
    hn_json_end_array(b);
    hn_json_key(b, "numbers");
    hn_json_object(b);
    for (int i = 0; i < x->draw.n_names; i++) {
        if (!hn_exercise_is_hidden(p, x->draw.name[i])) {
            hn_json_put_number(b, x->draw.name[i], x->draw.value[0][i]);
        }
    }
    hn_json_end_object(b);
    hn_exercise_put_ranges(b, p);
    put_submission(b, x);
    hn_json_put_int(b, "hints", p->n_hints);
    hn_json_end_object(b);
}
