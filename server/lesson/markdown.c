// SPDX-License-Identifier: GPL-3.0-or-later
#include "lesson/markdown.h"

#include "base/strbuf.h"

#include <md4c.h>
#include <stdio.h>
#include <string.h>

enum { MAX_DEPTH = 64 };

/// The nodes that are open, outermost first; open[0] holds the document's children.
typedef struct builder {
    cJSON *open[MAX_DEPTH];
    int depth;
    int head; ///< inside the head of a table
    hn_status status;
} builder;

/// A new node of a kind, appended to the array; NULL when memory is out.
static cJSON *add_block(cJSON *children, const char *kind) {
    cJSON *node = cJSON_CreateObject();
    if (!node || !cJSON_AddStringToObject(node, "kind", kind) ||
        !cJSON_AddItemToArray(children, node)) {
        cJSON_Delete(node);
        return NULL;
    }
    return node;
}

static cJSON *children_of(cJSON *node) {
    cJSON *children = cJSON_GetObjectItemCaseSensitive(node, "children");
    return children ? children : cJSON_AddArrayToObject(node, "children");
}

/// Opens a node inside the innermost one; NULL, with the status set, where that fails.
static cJSON *push(builder *b, const char *kind) {
    cJSON *inner = b->depth == 0 ? b->open[0] : children_of(b->open[b->depth]);
    cJSON *node = inner ? add_block(inner, kind) : NULL;
    if (!node) {
        b->status = HN_ERR_MEMORY;
    } else if (b->depth + 1 == MAX_DEPTH) {
        b->status = HN_ERR_LIMIT;
        node = NULL;
    } else {
        b->open[++b->depth] = node;
    }
    return node;
}

static int is_kind(const cJSON *node, const char *kind) {
    const char *found = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(node, "kind"));
    return found && strcmp(found, kind) == 0;
}

/// A paragraph that holds one picture and nothing else becomes a figure.
static void make_figure(cJSON *paragraph) {
    cJSON *children = cJSON_GetObjectItemCaseSensitive(paragraph, "children");
    cJSON *only = children ? children->child : NULL;
    if (!only || only->next || !is_kind(only, "figure")) {
        return;
    }
    cJSON *src = cJSON_DetachItemFromObject(only, "src");
    cJSON *caption = cJSON_DetachItemFromObject(only, "children");
    cJSON_DeleteItemFromObject(paragraph, "children");
    cJSON_SetValuestring(cJSON_GetObjectItemCaseSensitive(paragraph, "kind"), "figure");
    cJSON_AddItemToObject(paragraph, "src", src);
    cJSON_AddItemToObject(paragraph, "children", caption ? caption : cJSON_CreateArray());
}

static void add_text(builder *b, cJSON *node, const char *key, const MD_CHAR *text, size_t n) {
    char *copy = node ? strndup(text, n) : NULL;
    if (!copy || !cJSON_AddStringToObject(node, key, copy)) {
        b->status = HN_ERR_MEMORY;
    }
    free(copy);
}

static void enter_list(builder *b, int ordered, unsigned start) {
    cJSON *node = push(b, "list");
    cJSON_AddBoolToObject(node, "ordered", ordered);
    cJSON_AddNumberToObject(node, "start", start);
}

static void enter_cell(builder *b, const MD_BLOCK_TD_DETAIL *cell) {
    static const char *const names[] = {"", "left", "center", "right"};
    cJSON_AddStringToObject(push(b, "cell"), "align", names[cell->align]);
}

static void enter_code(builder *b, const MD_BLOCK_CODE_DETAIL *code) {
    cJSON *node = push(b, "code");
    add_text(b, node, "info", code->info.text ? code->info.text : "", code->info.size);
    add_text(b, node, "text", "", 0);
}

/// A table, its head and body, a row, or a cell.
static void enter_table(builder *b, MD_BLOCKTYPE type, void *detail) {
    if (type == MD_BLOCK_TABLE) {
        push(b, "table");
    } else if (type == MD_BLOCK_THEAD || type == MD_BLOCK_TBODY) {
        b->head = type == MD_BLOCK_THEAD;
    } else if (type == MD_BLOCK_TR) {
        cJSON_AddBoolToObject(push(b, "row"), "head", b->head);
    } else {
        enter_cell(b, detail);
    }
}

static int enter_block(MD_BLOCKTYPE type, void *detail, void *user) {
    builder *b = user;
    switch (type) {
    case MD_BLOCK_DOC:
        break;
    case MD_BLOCK_H:
        cJSON_AddNumberToObject(push(b, "heading"), "level", ((MD_BLOCK_H_DETAIL *)detail)->level);
        break;

    // lists, and blocks apart from the running text
    case MD_BLOCK_UL:
        enter_list(b, 0, 1);
        break;
    case MD_BLOCK_OL:
        enter_list(b, 1, ((MD_BLOCK_OL_DETAIL *)detail)->start);
        break;
    case MD_BLOCK_LI:
        push(b, "item");
        break;
    case MD_BLOCK_QUOTE:
        push(b, "quote");
        break;
    case MD_BLOCK_HR:
        push(b, "rule");
        break;
    case MD_BLOCK_CODE:
        enter_code(b, detail);
        break;
    case MD_BLOCK_TABLE:
    case MD_BLOCK_THEAD:
    case MD_BLOCK_TBODY:
    case MD_BLOCK_TR:
    case MD_BLOCK_TH:
    case MD_BLOCK_TD:
        enter_table(b, type, detail);
        break;
    default:
        push(b, "paragraph");
    }
    return b->status != HN_OK;
}

static int leave_block(MD_BLOCKTYPE type, void *detail, void *user) {
    builder *b = user;
    (void)detail;
    if (type == MD_BLOCK_DOC || type == MD_BLOCK_THEAD || type == MD_BLOCK_TBODY) {
        return 0;
    }
    if (type == MD_BLOCK_P) {
        make_figure(b->open[b->depth]);
    }
    b->depth--;
    return 0;
}

static int enter_span(MD_SPANTYPE type, void *detail, void *user) {
    builder *b = user;
    cJSON *node;

    switch (type) {
    // styles
    case MD_SPAN_EM:
        push(b, "em");
        break;

    // what points to a place
    case MD_SPAN_A:
        node = push(b, "link");
        add_text(b, node, "href", ((MD_SPAN_A_DETAIL *)detail)->href.text,
                 ((MD_SPAN_A_DETAIL *)detail)->href.size);
        break;
    case MD_SPAN_IMG:
        node = push(b, "figure");
        add_text(b, node, "src", ((MD_SPAN_IMG_DETAIL *)detail)->src.text,
                 ((MD_SPAN_IMG_DETAIL *)detail)->src.size);
        break;

    // what is kept as it is written; the text is added later
    case MD_SPAN_CODE:
        add_text(b, push(b, "mono"), "text", "", 0);
        break;
    case MD_SPAN_LATEXMATH:
    case MD_SPAN_LATEXMATH_DISPLAY:
        node = push(b, "math");
        add_text(b, node, "tex", "", 0);
        cJSON_AddBoolToObject(node, "display", type == MD_SPAN_LATEXMATH_DISPLAY);
        break;
    default:
        push(b, "strong");
    }
    return b->status != HN_OK;
}

static int leave_span(MD_SPANTYPE type, void *detail, void *user) {
    (void)type;
    (void)detail;
    ((builder *)user)->depth--;
    return 0;
}

/// Appends to the text that the innermost node has already.
static void extend(builder *b, const char *key, const MD_CHAR *text, size_t n) {
    cJSON *node = cJSON_GetObjectItemCaseSensitive(b->open[b->depth], key);
    hn_strbuf all;
    hn_strbuf_init(&all);
    hn_strbuf_add(&all, node && node->valuestring ? node->valuestring : "");
    hn_strbuf_add_n(&all, text, n);
    if (!node || all.failed || !cJSON_SetValuestring(node, hn_strbuf_text(&all))) {
        b->status = HN_ERR_MEMORY;
    }
    hn_strbuf_reset(&all);
}

static int add_run(MD_TEXTTYPE type, const MD_CHAR *text, MD_SIZE size, void *user) {
    builder *b = user;
    if (type == MD_TEXT_CODE) {
        extend(b, "text", text, size);
    } else if (type == MD_TEXT_LATEXMATH || is_kind(b->open[b->depth], "math")) {
        extend(b, "tex", type == MD_TEXT_SOFTBR ? " " : text, type == MD_TEXT_SOFTBR ? 1 : size);
    } else {
        cJSON *node = push(b, type == MD_TEXT_BR ? "break" : "text");
        if (node && type != MD_TEXT_BR) {
            add_text(b, node, "text", type == MD_TEXT_SOFTBR ? " " : text,
                     type == MD_TEXT_SOFTBR ? 1 : size);
        }
        b->depth -= node != NULL;
    }
    return b->status != HN_OK;
}

hn_status hn_markdown_parse(const char *text, size_t n, cJSON *children) {
    builder b = {.status = HN_OK};
    b.open[0] = children;
    const MD_PARSER parser = {.flags = MD_FLAG_TABLES | MD_FLAG_LATEXMATHSPANS | MD_FLAG_NOHTML,
                              .enter_block = enter_block,
                              .leave_block = leave_block,
                              .enter_span = enter_span,
                              .leave_span = leave_span,
                              .text = add_run};
    const int result = md_parse(text, (MD_SIZE)n, &parser, &b);
    return b.status != HN_OK ? b.status : result == 0 ? HN_OK : HN_ERR_MEMORY;
}
