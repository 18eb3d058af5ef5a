// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_XML_H
#define HN_IMPORT_XML_H
// XML as a tree, bounded in size and depth, without a document type, entities of its own or
// anything from outside; and attributes as numbers.

#include "import/build.h"

/// Returns owned (xmlFreeDoc); NULL after a fault with line and column. Elements know `file`; the
/// names are shared with `beside` (or NULL), so that elements may be moved there.
xmlDoc *hn_im_parse(hn_build *b, hn_im_file *file, const char *text, size_t n,
                    const xmlDoc *beside);
/// 0 after a fault: elements within each other deeper than are read. `depth` is that of the node.
bool hn_im_check_depth(hn_build *b, const xmlNode *node, int depth);

bool hn_im_is(const xmlNode *node, const char *name); ///< an element of this name
const xmlNode *hn_im_first(const xmlNode *parent);    ///< first child that is an element, or NULL
const xmlNode *hn_im_next(const xmlNode *node);       ///< next sibling that is an element
const xmlNode *hn_im_child(const xmlNode *parent, const char *name); ///< first child of this name
/// Text of an attribute, NULL if there is none; lives as long as the document. `node` may be NULL.
const char *hn_im_attr(hn_build *b, const xmlNode *node, const char *name);

/// Numbers separated by white space: at least `least`, at most `most`, all finite. Their count, or
/// -1 after a fault reported at node and attribute.
int hn_im_numbers(hn_build *b, const xmlNode *node, const char *attribute, const char *text,
                  int least, int most, double *out);
/// An attribute that has to have n numbers; 0 when absent, 1 when read, -1 after a fault.
int hn_im_vector(hn_build *b, const xmlNode *node, const char *attribute, int n, double *out);
/// "true" or "false"; `otherwise` when absent, -1 after a fault.
int hn_im_flag(hn_build *b, const xmlNode *node, const char *attribute, int otherwise);
/// 1 when `word` is among the words of `list`, separated by spaces.
bool hn_im_lists(const char *list, const char *word);

/// The treatment of attributes by a reader: rows {attributes, outcome, why}; the last has NULL.
/// Attributes of rows with outcome HN_IMPORT_OUTCOME_COUNT are used.
typedef struct hn_im_rule {
    const char *attributes;
    hn_import_outcome outcome;
    const char *why;
} hn_im_rule;
/// Names every attribute that is not used; numbers that are all 0 change nothing.
void hn_im_check_attributes(hn_build *b, const xmlNode *node, const hn_im_rule *rules);
/// Names an element that is not read, and everything in it.
void hn_im_skip(hn_build *b, hn_import_outcome outcome, const xmlNode *node, const char *why);
/// Names elements one by one: each child of a section that is not read.
void hn_im_skip_children(hn_build *b, hn_import_outcome outcome, const xmlNode *section,
                         const char *why);
#endif
