// SPDX-License-Identifier: GPL-3.0-or-later
#include "lesson/lesson_text.h"

#include "lesson/tex_ascii.h"
#include "lesson/tex_text.h"
#include "terminal/cells.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { MAX_COLUMNS = 12, INDENT = 4, GUTTER = 2, MIN_COLUMN = 6 };
static const char PICTURE[] = "[picture] "; // before the caption of one

/// The member of a formula that holds its spelling in ASCII.
static const char SPELLED[] = "ascii";

static const char *text_of(const cJSON *node, const char *key) {
    const char *text = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(node, key));
    return text ? text : "";
}

static bool is_kind(const cJSON *node, const char *kind) {
    return strcmp(text_of(node, "kind"), kind) == 0;
}

static const cJSON *children_of(const cJSON *node) {
    return cJSON_GetObjectItemCaseSensitive(node, "children");
}

// ---- nodes of a line ----

static void put_line(hn_strbuf *b, const cJSON *nodes);

static void put_math(hn_strbuf *b, const cJSON *node) {
    const bool display = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(node, "display"));
    hn_strbuf tex;
    hn_strbuf_init(&tex);
    if (text_of(node, SPELLED)[0]) {
        hn_strbuf_add(&tex, text_of(node, SPELLED));
    } else {
        hn_tex_text(&tex, text_of(node, "tex"));
    }
    hn_strbuf_add(b, display ? "\n\n" : "");

    // a display on lines of its own, indented; \x01 keeps its blanks from being folded
    for (const char *p = hn_strbuf_text(&tex); *p && display;) {
        const size_t n = strcspn(p, "\n"), blanks = strspn(p, " ");
        hn_strbuf_printf(b, "\x01    %.*s\n", (int)(n - (blanks < n ? blanks : n)), p + blanks);
        p += n + (p[n] == '\n');
    }
    hn_strbuf_add(b, display ? "\n" : hn_strbuf_text(&tex));
    hn_strbuf_reset(&tex);
}

static void put_node(hn_strbuf *b, const cJSON *node) {
    if (is_kind(node, "text")) {
        hn_strbuf_add(b, text_of(node, "text"));
    } else if (is_kind(node, "mono")) {
        hn_strbuf_printf(b, "`%s`", text_of(node, "text"));
    } else if (is_kind(node, "math")) {
        put_math(b, node);
    } else if (is_kind(node, "break")) {
        hn_strbuf_add(b, "\n");
    } else if (is_kind(node, "figure")) {
        // one of several in a paragraph: a line of its own
        hn_strbuf_add(b, PICTURE);
        put_line(b, children_of(node));
        hn_strbuf_add(b, "\n");
    } else {
        put_line(b, children_of(node)); // emphasis has no sign of its own in plain text
    }
    if (is_kind(node, "link") && strstr(text_of(node, "href"), "://")) {
        hn_strbuf_printf(b, " <%s>", text_of(node, "href"));
    }
}

static void put_line(hn_strbuf *b, const cJSON *nodes) {
    const cJSON *node;
    cJSON_ArrayForEach(node, nodes) {
        put_node(b, node);
    }
}

static size_t word_columns(const char *word, size_t n) {
    char copy[256];
    snprintf(copy, sizeof copy, "%.*s", (int)(n < 255 ? n : 255), word);
    return (size_t)hn_text_columns(copy);
}

/// Writes text in lines of `width` columns behind `indent` blanks; the first line begins with
/// `head`.
static void put_folded(hn_strbuf *b, const char *text, int indent, int width, const char *head) {
    int column = hn_text_columns(head), started = 0;
    hn_strbuf_add(b, head);

    while (*text) {
        if (*text == '\x01') { // a line of a display
            const size_t n = strcspn(text + 1, "\n");
            hn_strbuf_printf(b, "%*s%.*s\n", indent, "", (int)n, text + 1);
            text += 1 + n + (text[1 + n] == '\n');
            column = started = 0;
            continue;
        }

        // the next word goes onto a new line when this one is full
        const size_t n = strcspn(text, " \n\x01");
        const int columns = (int)word_columns(text, n);
        if (n > 0 && started && column + 1 + columns > width) {
            hn_strbuf_add(b, "\n");
            column = started = 0;
        }

        // a blank between words, or the indent before the first
        if (n > 0) {
            hn_strbuf_printf(b, "%*s", started ? 1 : column >= indent ? 0 : indent - column, "");
            column = started ? column + 1 : column >= indent ? column : indent;
            hn_strbuf_add_n(b, text, n);
            column += columns;
            started = 1;
        }

        // a break of the source ends the line
        text += n;
        if (*text == '\n') {
            hn_strbuf_add(b, "\n");
            column = started = 0;
        }
        text += *text == ' ' || *text == '\n';
    }

    hn_strbuf_add(b, column > 0 ? "\n" : "");
}

// ---- blocks ----

static void put_blocks(hn_strbuf *b, const cJSON *nodes, int indent, int width);

static void put_inline(hn_strbuf *b, const cJSON *nodes, int indent, int width, const char *head) {
    hn_strbuf line;
    hn_strbuf_init(&line);
    put_line(&line, nodes);
    put_folded(b, hn_strbuf_text(&line), indent, width, head);
    b->failed |= line.failed;
    hn_strbuf_reset(&line);
}

static void put_heading(hn_strbuf *b, const cJSON *node, int width) {
    const double level = cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(node, "level"));
    hn_strbuf line;
    hn_strbuf_init(&line);
    put_line(&line, children_of(node));
    const int n = hn_text_columns(hn_strbuf_text(&line));
    put_folded(b, hn_strbuf_text(&line), 0, width, "");
    for (int i = 0; i < n && i < width && level < 3; i++) {
        hn_strbuf_add(b, level < 2 ? "=" : "-");
    }
    hn_strbuf_add(b, level < 3 ? "\n" : "");
    hn_strbuf_reset(&line);
}

/// 1 when an item holds nodes of a line rather than blocks.
static bool holds_line(const cJSON *item) {
    const cJSON *first = children_of(item) ? children_of(item)->child : NULL;
    static const char *const kinds[] = {"text", "mono", "math", "strong", "em", "link", "break"};
    for (int i = 0; i < 7 && first; i++) {
        if (is_kind(first, kinds[i])) {
            return true;
        }
    }
    return false;
}

static void put_list(hn_strbuf *b, const cJSON *node, int indent, int width) {
    // the numbering goes on from the first number
    const bool ordered = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(node, "ordered"));
    int number = (int)cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(node, "start"));
    const cJSON *item;

    // each item behind its mark
    cJSON_ArrayForEach(item, children_of(node)) {
        char head[40];
        snprintf(head, sizeof head, ordered ? "%*s%d. " : "%*s* ", indent, "", number++);
        const int inner = indent + (ordered ? 3 : 2);

        // an item of one line, or of blocks
        if (holds_line(item)) {
            put_inline(b, children_of(item), inner, width, head);
        } else {
            // the first block stands beside the mark, the others below it
            const cJSON *first = children_of(item) ? children_of(item)->child : NULL;
            put_inline(b, children_of(first), inner, width, head);
            for (const cJSON *m = first ? first->next : NULL; m; m = m->next) {
                cJSON *one = cJSON_CreateArray();
                cJSON_AddItemToArray(one, cJSON_Duplicate(m, 1));
                put_blocks(b, one, inner, width);
                cJSON_Delete(one);
            }
        }
    }
}

/// The cells of a row as text; `widths` grows to the longest of each column.
static void measure_row(const cJSON *row, int widths[MAX_COLUMNS]) {
    int k = 0;
    const cJSON *cell;
    cJSON_ArrayForEach(cell, children_of(row)) {
        hn_strbuf line;
        hn_strbuf_init(&line);
        put_line(&line, children_of(cell));
        const int n = hn_text_columns(hn_strbuf_text(&line));
        if (k < MAX_COLUMNS) {
            widths[k] = n > widths[k] ? n : widths[k];
            k++;
        }
        hn_strbuf_reset(&line);
    }
}

/// Narrows the widest columns until a row fits into `room` characters.
static void fit_columns(int widths[MAX_COLUMNS], int room) {
    int total = -GUTTER;
    for (int k = 0; k < MAX_COLUMNS && widths[k]; k++) {
        total += widths[k] + GUTTER;
    }

    for (; total > room; total--) {
        int widest = 0;
        for (int k = 1; k < MAX_COLUMNS; k++) {
            widest = widths[k] > widths[widest] ? k : widest;
        }
        if (widths[widest] <= MIN_COLUMN) {
            return; // more columns than the terminal can hold: the row runs over
        }
        widths[widest]--;
    }
}

/// Appends one line of a cell with the blanks of its column, and steps `*rest` behind it.
static void put_cell_line(hn_strbuf *b, const char **rest, int width, bool right, bool last) {
    const size_t bytes = strcspn(*rest, "\n");
    const int used = (int)word_columns(*rest, bytes);
    const int blank = width > used ? width - used : 0;
    hn_strbuf_printf(b, "%*s%.*s%*s", right ? blank : 0, "", (int)bytes, *rest,
                     right || last ? 0 : blank, "");
    *rest += bytes + ((*rest)[bytes] == '\n');
}

static void put_row(hn_strbuf *b, const cJSON *row, const int widths[MAX_COLUMNS], int indent) {
    hn_strbuf cells[MAX_COLUMNS];
    const char *rest[MAX_COLUMNS];
    bool right[MAX_COLUMNS];
    int n = 0;

    // the text of each cell, folded to its column
    const cJSON *cell;
    cJSON_ArrayForEach(cell, children_of(row)) {
        if (n < MAX_COLUMNS) {
            hn_strbuf_init(&cells[n]);
            put_inline(&cells[n], children_of(cell), 0, widths[n], "");
            rest[n] = hn_strbuf_text(&cells[n]);
            right[n] = strcmp(text_of(cell, "align"), "right") == 0;
            n++;
        }
    }

    // line by line, until every cell is at its end
    for (bool more = n > 0; more;) {
        more = false;
        hn_strbuf_printf(b, "%*s", indent, "");
        for (int k = 0; k < n; k++) {
            put_cell_line(b, &rest[k], widths[k], right[k], k == n - 1);
            hn_strbuf_printf(b, "%*s", k < n - 1 ? GUTTER : 0, "");
            more = more || *rest[k];
        }
        hn_strbuf_add(b, "\n");
    }

    for (int k = 0; k < n; k++) {
        b->failed |= cells[k].failed;
        hn_strbuf_reset(&cells[k]);
    }
}

static void put_rule(hn_strbuf *b, const int widths[MAX_COLUMNS], int indent) {
    for (int k = 0; k < MAX_COLUMNS && widths[k]; k++) {
        hn_strbuf_printf(b, "%*s", k == 0 ? indent : GUTTER, "");
        for (int column = 0; column < widths[k]; column++) {
            hn_strbuf_add(b, "-");
        }
    }
    hn_strbuf_add(b, "\n");
}

static void put_table(hn_strbuf *b, const cJSON *node, int indent, int width) {
    int widths[MAX_COLUMNS] = {0};
    const cJSON *row;
    cJSON_ArrayForEach(row, children_of(node)) {
        measure_row(row, widths);
    }
    fit_columns(widths, width - indent);

    cJSON_ArrayForEach(row, children_of(node)) {
        put_row(b, row, widths, indent);
        if (cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(row, "head"))) {
            put_rule(b, widths, indent);
        }
    }
}

static void put_code(hn_strbuf *b, const char *text, int indent) {
    while (*text) {
        const size_t n = strcspn(text, "\n");
        hn_strbuf_printf(b, n ? "%*s%.*s\n" : "\n", n ? indent : 0, "", (int)n, text);
        text += n + (text[n] == '\n');
    }
}

/// A command on lines of its own. A longer one goes on behind a backslash, as a shell takes it.
static void put_command(hn_strbuf *b, const char *command, int indent, int width) {
    hn_strbuf_printf(b, "%*sholonom", indent, "");
    int column = indent + (int)strlen("holonom");

    while (*command) {
        // the next word, with room for the backslash
        const size_t n = strcspn(command, " ");
        if (column + 1 + (int)n + 2 > width) {
            hn_strbuf_printf(b, " \\\n%*s", indent + INDENT - 1, "");
            column = indent + INDENT - 1;
        }
        hn_strbuf_printf(b, " %.*s", (int)n, command);
        column += 1 + (int)n;
        command += n + (command[n] == ' ');
    }
    hn_strbuf_add(b, "\n");
}

static void put_exhibit(hn_strbuf *b, const cJSON *node, int indent, int width) {
    hn_strbuf_printf(b, "%*sTry it:\n", indent, "");
    put_command(b, text_of(node, "command"), indent + INDENT, width);
    put_blocks(b, children_of(node), indent, width);
}

static void put_choices(hn_strbuf *b, const cJSON *node, int indent, int width) {
    const cJSON *choice;
    char letter = 'a';
    cJSON_ArrayForEach(choice, cJSON_GetObjectItemCaseSensitive(node, "choices")) {
        char head[24];
        snprintf(head, sizeof head, "%*s(%c) ", indent, "", letter++);
        const cJSON *first = children_of(choice) ? children_of(choice)->child : NULL;
        put_inline(b, children_of(first), indent + INDENT, width, head);
    }
}

static void put_block(hn_strbuf *b, const cJSON *node, int indent, int width) {
    if (is_kind(node, "heading")) {
        put_heading(b, node, width);
    } else if (is_kind(node, "list")) {
        put_list(b, node, indent, width);
    } else if (is_kind(node, "table")) {
        put_table(b, node, indent, width);
    } else if (is_kind(node, "code")) {
        put_code(b, text_of(node, "text"), indent + INDENT);
    } else if (is_kind(node, "quote")) {
        put_blocks(b, children_of(node), indent + INDENT, width);
    } else if (is_kind(node, "exhibit")) {
        put_exhibit(b, node, indent, width);
    } else if (is_kind(node, "predict")) {
        hn_strbuf_printf(b, "%*sPredict first:\n", indent, "");
        put_blocks(b, children_of(node), indent, width);

        // the choices stand below the question
        put_choices(b, node, indent, width);
    } else if (is_kind(node, "slip")) {
        // a heading line, then the text below it
        hn_strbuf_printf(b, "%*sSlip %.0f of the printed lesson:\n", indent, "",
                         cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(node, "number")));
        put_blocks(b, children_of(node), indent + INDENT, width);
    } else if (is_kind(node, "exercise")) {
        hn_strbuf_printf(b, "%*sExercise %s:  holonom problem %s\n", indent, "",
                         text_of(node, "id"), text_of(node, "id"));
        put_blocks(b, children_of(node), indent + INDENT, width);
    } else if (is_kind(node, "figure")) {
        put_inline(b, children_of(node), indent, width, PICTURE);
    } else {
        put_inline(b, children_of(node), indent, width, "");
    }
}

/// A block and those behind it.
static void put_rest(hn_strbuf *b, const cJSON *node, int indent, int width) {
    for (; node; node = node->next) {
        put_block(b, node, indent, width);
        hn_strbuf_add(b, node->next ? "\n" : "");
    }
}

static void put_blocks(hn_strbuf *b, const cJSON *nodes, int indent, int width) {
    put_rest(b, nodes ? nodes->child : NULL, indent, width);
}

/// Writes what was seen in each prediction, below the lesson.
static void put_answers(hn_strbuf *b, const cJSON *blocks, int width) {
    const cJSON *node;
    int n = 0;
    cJSON_ArrayForEach(node, blocks) {
        if (is_kind(node, "predict")) {
            char head[32];
            hn_strbuf_add(b, n == 0 ? "\nAnswers to the predictions\n--------------------------\n"
                                    : "");
            const double right =
                cJSON_GetNumberValue(cJSON_GetObjectItemCaseSensitive(node, "right"));
            snprintf(head, sizeof head, "%d. (%c) ", ++n, 'a' + (int)right);
            const cJSON *after = cJSON_GetObjectItemCaseSensitive(node, "after");
            put_inline(b, children_of(after ? after->child : NULL), INDENT, width, head);

            // an answer may go on below its first paragraph
            if (after && after->child && after->child->next) {
                hn_strbuf_add(b, "\n");
                put_rest(b, after->child->next, INDENT, width);
                hn_strbuf_add(b, "\n");
            }
        }
    }
}

/// Copies the text without blanks at line ends and with at most one empty line in a row.
static void put_tidy(hn_strbuf *b, const hn_strbuf *text) {
    int ends = 2; // no empty lines at the start
    for (const char *p = hn_strbuf_text(text); *p;) {
        const size_t n = strcspn(p, "\n");
        size_t kept = n;
        while (kept > 0 && p[kept - 1] == ' ') {
            kept--;
        }
        ends = kept > 0 ? 1 : ends + 1;
        if (ends <= 2) {
            hn_strbuf_printf(b, "%.*s\n", (int)kept, p);
        }
        p += n + (p[n] == '\n');
    }
    b->failed |= text->failed;
}

void hn_lesson_spell_out(cJSON *lesson) {
    if (is_kind(lesson, "math")) {
        hn_strbuf b;
        hn_strbuf_init(&b);
        hn_tex_ascii(&b, text_of(lesson, "tex"));
        cJSON_AddStringToObject(lesson, SPELLED, hn_strbuf_text(&b));
        hn_strbuf_reset(&b);
        return;
    }
    cJSON *child;
    cJSON_ArrayForEach(child, lesson) {
        hn_lesson_spell_out(child);
    }
}

void hn_lesson_text(hn_strbuf *b, const cJSON *lesson, int columns) {
    const cJSON *blocks = cJSON_GetObjectItemCaseSensitive(lesson, "blocks");
    hn_strbuf all;
    hn_strbuf_init(&all);
    put_blocks(&all, blocks, 0, columns);
    put_answers(&all, blocks, columns);
    if (strstr(hn_strbuf_text(&all), PICTURE)) {
        hn_strbuf_printf(&all,
                         "\nThe page shows the pictures: 'holonom serve', then Lessons. They are "
                         "files in lessons/%s.\n",
                         text_of(lesson, "id"));
    }
    put_tidy(b, &all);
    hn_strbuf_reset(&all);
}
