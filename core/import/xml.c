// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/xml.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// ---- parsing ----

/// A document type can declare entities that grow without bound, and no mechanism needs one.
static void meet_document_type(void *context, const xmlChar *name, const xmlChar *external,
                               const xmlChar *system) {
    xmlParserCtxt *parser = context;
    (void)name;
    (void)external;
    (void)system;
    *(int *)parser->_private = parser->input ? parser->input->line : 1;
    xmlStopParser(parser);
}

static void keep_quiet(void *context, xmlErrorPtr error) {
    (void)context;
    (void)error;
}

static bool tell_syntax(hn_build *b, const hn_im_file *file, const xmlParserCtxt *parser) {
    const xmlError *e = &parser->lastError;
    char text[300];
    (void)snprintf(text, sizeof text, "%s", e->message ? e->message : "not XML");
    text[strcspn(text, "\n")] = '\0';
    if (strncmp(text, "Excessive depth", 15) == 0) {
        // the parser's own bound, which names an option of the library
        (void)snprintf(text, sizeof text, "elements are nested far too deep");
    }
    b->status = HN_ERR_INPUT;
    const bool is_none = strstr(text, "Start tag expected") != NULL;
    (void)hn_diags_add(b->diags, HN_ERR_INPUT, NULL,
                       is_none ? "give an MJCF or a URDF file, which is XML" : NULL,
                       "%s, column %d: %s", hn_im_line(b, file, e->line > 0 ? e->line : 1),
                       e->int2 > 0 ? e->int2 : 1, text);
    return false;
}

bool hn_im_check_depth(hn_build *b, const xmlNode *node, int depth) {
    if (depth > HN_IMPORT_MAX_DEPTH) {
        b->status = HN_ERR_LIMIT;
        (void)hn_diags_add(b->diags, HN_ERR_LIMIT, NULL, NULL,
                           "%s: elements are nested more than %d deep", hn_im_line_of(b, node),
                           HN_IMPORT_MAX_DEPTH);
        return false;
    }
    for (const xmlNode *c = hn_im_first(node); c; c = hn_im_next(c)) {
        if (!hn_im_check_depth(b, c, depth + 1)) {
            return false;
        }
    }
    return true;
}

/// Only included files need telling.
static void tell_file(xmlNode *node, hn_im_file *file) {
    for (; node; node = node->next) {
        node->_private = file;
        if (node->type == XML_ELEMENT_NODE) {
            tell_file(node->children, file);
        }
    }
}

static xmlDoc *parse(hn_build *b, hn_im_file *file, xmlParserCtxt *parser, const char *text,
                     size_t n) {
    int document_type = 0;
    parser->_private = &document_type;
    parser->sax->internalSubset = meet_document_type;
    parser->sax->serror = keep_quiet;
    xmlDoc *doc = xmlCtxtReadMemory(parser, text, (int)n, NULL, NULL,
                                    XML_PARSE_NONET | XML_PARSE_NOERROR | XML_PARSE_NOWARNING |
                                        XML_PARSE_NOCDATA | XML_PARSE_BIG_LINES);

    // a document type could pull in files and entities
    if (document_type) {
        b->status = HN_ERR_INPUT;
        (void)hn_diags_add(b->diags, HN_ERR_INPUT, NULL, "take the <!DOCTYPE ...> out",
                           "%s: a document type and its entities are not read",
                           hn_im_line(b, file, document_type));
    } else if (!doc || !parser->wellFormed) {
        tell_syntax(b, file, parser);
    } else {
        if (file->order > 0) {
            tell_file(doc->children, file);
        }
        if (hn_im_check_depth(b, xmlDocGetRootElement(doc), 1)) {
            return doc;
        }
    }
    xmlFreeDoc(doc);
    return NULL;
}

xmlDoc *hn_im_parse(hn_build *b, hn_im_file *file, const char *text, size_t n,
                    const xmlDoc *beside) {
    // what can be refused before the text is read
    if (n > HN_IMPORT_MAX_BYTES) {
        b->status = HN_ERR_LIMIT;
        (void)hn_diags_add(b->diags, HN_ERR_LIMIT, NULL, NULL,
                           "the file has %zu bytes, at most %d are read", n, HN_IMPORT_MAX_BYTES);
        return NULL;
    }
    hn_diag missing = {0};
    if (hn_libxml_load(&missing) != HN_OK) {
        b->status =
            hn_diags_add(b->diags, missing.status, NULL, missing.hint, "%s", missing.message);
        return NULL;
    }

    // names shared with the document beside it, so that nodes can move between them
    xmlParserCtxt *parser = xmlNewParserCtxt();
    if (!parser) {
        hn_im_out_of_memory(b);
        return NULL;
    }
    if (beside && beside->dict) {
        xmlDictFree(parser->dict);
        parser->dict = beside->dict;
        xmlDictReference(parser->dict);
    }

    xmlDoc *doc = parse(b, file, parser, text, n);
    xmlFreeParserCtxt(parser);
    return doc;
}

// ---- elements and attributes ----

bool hn_im_is(const xmlNode *node, const char *name) {
    return node && node->type == XML_ELEMENT_NODE && strcmp((const char *)node->name, name) == 0;
}

static const xmlNode *element_from(const xmlNode *node) {
    while (node && node->type != XML_ELEMENT_NODE) {
        node = node->next;
    }
    return node;
}

const xmlNode *hn_im_first(const xmlNode *parent) {
    return parent ? element_from(parent->children) : NULL;
}

const xmlNode *hn_im_next(const xmlNode *node) {
    return element_from(node->next);
}

const xmlNode *hn_im_child(const xmlNode *parent, const char *name) {
    const xmlNode *c = hn_im_first(parent);
    while (c && !hn_im_is(c, name)) {
        c = hn_im_next(c);
    }
    return c;
}

const char *hn_im_attr(hn_build *b, const xmlNode *node, const char *name) {
    const xmlAttr *a = node ? xmlHasProp(node, (const xmlChar *)name) : NULL;
    if (!a || !a->children) {
        return a ? "" : NULL;
    }
    if (!a->children->next && a->children->type == XML_TEXT_NODE) {
        return (const char *)a->children->content;
    }
    xmlChar *text = xmlNodeListGetString(node->doc, a->children, 1);
    if (!text) {
        return NULL;
    }
    const char *copy = hn_arena_strdup(b->arena, (const char *)text);
    xmlFree(text);
    if (!copy) {
        hn_im_out_of_memory(b);
    }
    return copy;
}

/// A decimal number, whatever sign the locale has for the point; hexadecimal, inf and nan are none.
static bool read_number(const char *word, size_t n, double *out) {
    enum { ROOM = 64 };
    char copy[ROOM];
    if (n == 0 || n >= ROOM || strspn(word, "+-.0123456789eE") < n) {
        return false;
    }
    memcpy(copy, word, n);
    copy[n] = '\0';
    char *point = strchr(copy, '.'), *end;
    if (point) {
        *point = localeconv()->decimal_point[0];
    }
    *out = strtod(copy, &end);
    return *end == '\0' && end != copy && isfinite(*out);
}

int hn_im_numbers(hn_build *b, const xmlNode *node, const char *attribute, const char *text,
                  int least, int most, double *out) {
    static const char SPACE[] = " \t\r\n";
    int n = 0;

    // each word is one number
    for (const char *p = text + strspn(text, SPACE); *p; p += strspn(p, SPACE)) {
        size_t length = strcspn(p, SPACE);
        double value;
        if (!read_number(p, length, &value)) {
            hn_im_fault(b, node, attribute, "a finite decimal number, as in 0.5 or 1e-3",
                        "'%.*s' is not a number", length > 40 ? 40 : (int)length, p);
            return -1;
        }
        if (n < most) {
            out[n] = value;
        }
        n++;
        p += length;
    }

    // too few or too many
    if (n < least || n > most) {
        if (least == most) {
            hn_im_fault(b, node, attribute, NULL, "%d numbers, expected %d", n, least);
        } else {
            hn_im_fault(b, node, attribute, NULL, "%d numbers, expected %d to %d", n, least, most);
        }
        return -1;
    }
    return n;
}

int hn_im_vector(hn_build *b, const xmlNode *node, const char *attribute, int n, double *out) {
    const char *text = hn_im_attr(b, node, attribute);
    return !text ? 0 : hn_im_numbers(b, node, attribute, text, n, n, out) < 0 ? -1 : 1;
}

int hn_im_flag(hn_build *b, const xmlNode *node, const char *attribute, int otherwise) {
    const char *text = hn_im_attr(b, node, attribute);
    if (!text) {
        return otherwise;
    }
    int yes = strcmp(text, "true") == 0;
    if (!yes && strcmp(text, "false") != 0) {
        hn_im_fault(b, node, attribute, "true or false", "'%.40s' is neither true nor false", text);
        return -1;
    }
    return yes;
}

bool hn_im_lists(const char *list, const char *word) {
    size_t n = strlen(word);
    for (const char *p = list; *p;) {
        size_t length = strcspn(p, " ");
        if (length == n && memcmp(p, word, n) == 0) {
            return true;
        }
        p += length;
        p += strspn(p, " ");
    }
    return false;
}

// ---- what is not used ----

/// Numbers, all of them 0.
static bool is_zero(const char *text) {
    return text[0] && text[strspn(text, " \t\r\n+-0.")] == '\0';
}

void hn_im_check_attributes(hn_build *b, const xmlNode *node, const hn_im_rule *rules) {
    for (const xmlAttr *a = node->properties; a; a = a->next) {
        const char *name = (const char *)a->name;
        const hn_im_rule *rule = rules;
        while (rule->attributes && !hn_im_lists(rule->attributes, name)) {
            rule++;
        }
        if (!rule->attributes) {
            hn_im_note(b, HN_IMPORT_REFUSED, node, name, "unknown attribute of '%s': not read",
                       (const char *)node->name);
        } else if (rule->outcome != HN_IMPORT_OUTCOME_COUNT) {
            const char *text = hn_im_attr(b, node, name);
            int nothing = rule->outcome == HN_IMPORT_REFUSED && text && is_zero(text);
            hn_im_note(b, nothing ? HN_IMPORT_IGNORED : rule->outcome, node, name, "%s",
                       nothing ? "0 changes nothing" : rule->why);
        }
    }
}

static int count_inside(const xmlNode *node) {
    int n = 0;
    for (const xmlNode *c = hn_im_first(node); c; c = hn_im_next(c)) {
        n += 1 + count_inside(c);
    }
    return n;
}

void hn_im_skip(hn_build *b, hn_import_outcome outcome, const xmlNode *node, const char *why) {
    int inside = count_inside(node);
    if (inside) {
        hn_im_note(b, outcome, node, NULL, "%s (with the %d elements in it)", why, inside);
    } else {
        hn_im_note(b, outcome, node, NULL, "%s", why);
    }
}

void hn_im_skip_children(hn_build *b, hn_import_outcome outcome, const xmlNode *section,
                         const char *why) {
    for (const xmlNode *c = hn_im_first(section); c; c = hn_im_next(c)) {
        hn_im_skip(b, outcome, c, why);
    }
}
