// SPDX-License-Identifier: GPL-3.0-or-later
// <include file="..."/>: the elements of another file in the place of this one, anywhere in a
// model, before anything is read. As in MuJoCo the file's root is left out, whatever it is called,
// names are relative to the folder of the model's own file, and each file is included once at most.
#include "import/mjcf.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

static const hn_im_rule USED[] = {{"file", HN_IMPORT_OUTCOME_COUNT, NULL},
                                  {NULL, HN_IMPORT_REFUSED, NULL}};

typedef struct including {
    hn_build *b;
    const hn_import_source *source;
    xmlDoc *doc;
    size_t n_bytes; ///< of all files so far
} including;

// ---- names ----

/// "./parts//leg.xml" as "parts/leg.xml", in the arena; NULL after a fault where it leads out of
/// the model's folder.
static const char *settle_name(including *in, const xmlNode *node, const char *name) {
    const size_t n = strlen(name);
    const bool drive = isalpha((unsigned char)name[0]) && name[1] == ':';
    char *out = hn_arena_get(in->b->arena, n + 1);
    size_t used = 0;
    if (!out) {
        hn_im_out_of_memory(in->b);
        return NULL;
    }

    // names that lead elsewhere on any system
    if (name[0] == '/' || drive || strchr(name, '\\')) {
        hn_im_fault(in->b, node, "file", "copy it beside the model; folders are parted by /",
                    "'%.80s' is not a file below the model's own folder, and others are not read",
                    name);
        return NULL;
    }

    // part by part, without "." and empty parts
    for (const char *part = name; *part;) {
        const size_t length = strcspn(part, "/");
        if (length == 2 && strncmp(part, "..", 2) == 0) {
            hn_im_fault(in->b, node, "file", "copy it beside the model",
                        "'%.80s' leads out of the model's folder, and files there are not read",
                        name);
            return NULL;
        }
        if (length > 0 && !(length == 1 && part[0] == '.')) {
            used += (size_t)snprintf(out + used, n + 1 - used, "%s%.*s", used ? "/" : "",
                                     (int)length, part);
        }
        part += length + (part[length] == '/');
    }
    if (used == 0) {
        hn_im_fault(in->b, node, "file", "as in file=\"leg.xml\"", "this is no file: '%.80s'",
                    name);
    }
    return used > 0 ? out : NULL;
}

/// "a.xml > b.xml > a.xml": from the file that is included again to where that is asked for.
static const char *tell_circle(including *in, const hn_im_file *from, const char *name) {
    const char *chain = hn_im_text(in->b, "%.60s", name);
    for (const hn_im_file *f = from; f && chain; f = f->includer) {
        chain = hn_im_text(in->b, "%.60s > %s", f->name, chain);
        if (strcmp(f->name, name) == 0) {
            break;
        }
    }
    return chain ? chain : "";
}

/// 0 after a fault: a file that is there already, or is being read.
static bool check_new(including *in, const xmlNode *node, const char *name) {
    const hn_im_file *from = hn_im_file_of(in->b, node), *f = from;
    while (f && strcmp(f->name, name) != 0) {
        f = f->includer;
    }
    if (f) {
        return hn_im_fault(in->b, node, "file", "take one of these includes out",
                           "files include each other in a circle: %s", tell_circle(in, from, name));
    }
    for (int i = 0; i < in->b->n_files; i++) {
        if (strcmp(in->b->files[i].name, name) == 0) {
            return hn_im_fault(in->b, node, "file", "MuJoCo takes each file once, too",
                               "'%.80s' is included already", name);
        }
    }
    return true;
}

// ---- files ----

static hn_im_file *add_file(including *in, const xmlNode *node, const char *name) {
    hn_im_file *from = hn_im_file_of(in->b, node);
    const int depth = from->depth + 1;
    if (depth > HN_IMPORT_MAX_INCLUDES_DEEP || in->b->n_files == HN_IMPORT_MAX_FILES) {
        in->b->status = HN_ERR_LIMIT;
        hn_im_fault(in->b, node, "file", NULL,
                    "files include each other more than %d deep, or there are more than %d",
                    HN_IMPORT_MAX_INCLUDES_DEEP, HN_IMPORT_MAX_FILES);
        return NULL;
    }
    hn_im_file *file = &in->b->files[in->b->n_files];
    *file = (hn_im_file){.name = name, .order = in->b->n_files++, .depth = depth, .includer = from};
    return file;
}

/// The file as a tree, which shares its names with the model's; NULL after a fault.
static xmlDoc *read_file(including *in, const xmlNode *node, hn_im_file *file) {
    const size_t most = HN_IMPORT_MAX_BYTES - in->n_bytes;
    hn_strbuf text;
    hn_diag diag = {0};
    xmlDoc *doc = NULL;
    hn_strbuf_init(&text);

    // the caller reads; sizes are bounded over all files
    const hn_status status = in->source->read(in->source->user, file->name, most, &text, &diag);
    if (status == HN_ERR_MEMORY || text.failed) {
        hn_im_out_of_memory(in->b);
    } else if (status != HN_OK) {
        in->b->status = status;
        hn_im_fault(in->b, node, "file", diag.hint, "%s", diag.message);
    } else if (text.n > most) {
        in->b->status = HN_ERR_LIMIT;
        hn_im_fault(in->b, node, "file", NULL,
                    "with '%.80s' the model has more than %d bytes in all its files", file->name,
                    HN_IMPORT_MAX_BYTES);
    } else {
        in->n_bytes += text.n;
        doc = hn_im_parse(in->b, file, hn_strbuf_text(&text), text.n, in->doc);
    }
    hn_strbuf_reset(&text);
    return doc;
}

// ---- trees ----

static bool expand(including *in, xmlNode *parent);

/// Replaces `node` by the children of `root`.
static void put_in_place(xmlNode *node, xmlNode *root) {
    for (xmlNode *c = root->children, *next; c; c = next) {
        next = c->next;
        xmlUnlinkNode(c);
        (void)xmlAddPrevSibling(node, c);
    }
    xmlUnlinkNode(node);
    xmlFreeNode(node);
}

static bool include(including *in, xmlNode *node) {
    const char *wanted = hn_im_attr(in->b, node, "file");

    // a file that can be read
    hn_im_check_attributes(in->b, node, USED);
    if (!wanted) {
        return hn_im_fault(in->b, node, NULL, "as in <include file=\"leg.xml\"/>",
                           "this include names no file");
    }
    if (!in->source->read) {
        return hn_im_fault(
            in->b, node, "file", "import the model from its file",
            "the folder of '%.80s' is not known, because the model was not read from a file",
            wanted);
    }
    if (hn_im_first(node)) {
        hn_im_skip_children(in->b, HN_IMPORT_REFUSED, node,
                            "not read: the include around it is replaced by its file");
    }

    // read once, with the files that it includes itself
    const char *name = settle_name(in, node, wanted);
    hn_im_file *file = name && check_new(in, node, name) ? add_file(in, node, name) : NULL;
    xmlDoc *doc = file ? read_file(in, node, file) : NULL;
    const bool ok = doc && expand(in, xmlDocGetRootElement(doc));
    if (ok) {
        put_in_place(node, xmlDocGetRootElement(doc));
    }
    xmlFreeDoc(doc);
    return ok;
}

/// Every include below an element; 0 after a fault.
static bool expand(including *in, xmlNode *parent) {
    for (xmlNode *c = parent->children, *next; c; c = next) {
        next = c->next;
        const bool is_include = hn_im_is(c, "include");
        if (c->type == XML_ELEMENT_NODE && !(is_include ? include(in, c) : expand(in, c))) {
            return false;
        }
    }
    return true;
}

bool hn_im_include(hn_build *b, xmlDoc *doc, const hn_import_source *source) {
    including in = {.b = b, .source = source, .doc = doc, .n_bytes = source->n};
    return expand(&in, xmlDocGetRootElement(doc)) &&
           hn_im_check_depth(b, xmlDocGetRootElement(doc), 1);
}
