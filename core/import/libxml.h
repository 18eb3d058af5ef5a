// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_IMPORT_LIBXML_H
#define HN_IMPORT_LIBXML_H
// libxml2, loaded when the first file is imported and kept: it brings the tables of ICU, 30 MB of
// addresses, which no other command needs. After hn_libxml_load its functions are called by their
// own names.

#include "base/diag.h"

#include <libxml/parser.h>
#include <libxml/parserInternals.h>
#include <libxml/tree.h>

/// The functions that importing needs; the names are theirs.
#define HN_LIBXML_LIST(X)   \
    X(xmlAddPrevSibling)    \
    X(xmlCtxtReadMemory)    \
    X(xmlDictFree)          \
    X(xmlDictReference)     \
    X(xmlDocGetRootElement) \
    X(xmlFreeDoc)           \
    X(xmlFreeNode)          \
    X(xmlFreeParserCtxt)    \
    X(xmlGetLineNo)         \
    X(xmlGetNodePath)       \
    X(xmlHasProp)           \
    X(xmlNewParserCtxt)     \
    X(xmlNodeListGetString) \
    X(xmlStopParser)        \
    X(xmlUnlinkNode)

typedef struct hn_libxml {
#define HN_LIBXML_MEMBER(name) __typeof__(name) *name;
    HN_LIBXML_LIST(HN_LIBXML_MEMBER)
#undef HN_LIBXML_MEMBER
    xmlFreeFunc *free; ///< its variable xmlFree
} hn_libxml;

/// Filled by hn_libxml_load, and constant from then on.
extern hn_libxml hn_libxml_functions;

/// Loads the library once, from any thread. Fails: HN_ERR_UNSUPPORTED, with the package to install.
HN_MUST_CHECK hn_status hn_libxml_load(hn_diag *diag);

#ifndef HN_LIBXML_OWN_NAMES
#define xmlAddPrevSibling hn_libxml_functions.xmlAddPrevSibling
#define xmlCtxtReadMemory hn_libxml_functions.xmlCtxtReadMemory
#define xmlDictFree hn_libxml_functions.xmlDictFree
#define xmlDictReference hn_libxml_functions.xmlDictReference
#define xmlDocGetRootElement hn_libxml_functions.xmlDocGetRootElement
#define xmlFree (*hn_libxml_functions.free)
#define xmlFreeDoc hn_libxml_functions.xmlFreeDoc
#define xmlFreeNode hn_libxml_functions.xmlFreeNode
#define xmlFreeParserCtxt hn_libxml_functions.xmlFreeParserCtxt
#define xmlGetLineNo hn_libxml_functions.xmlGetLineNo
#define xmlGetNodePath hn_libxml_functions.xmlGetNodePath
#define xmlHasProp hn_libxml_functions.xmlHasProp
#define xmlNewParserCtxt hn_libxml_functions.xmlNewParserCtxt
#define xmlNodeListGetString hn_libxml_functions.xmlNodeListGetString
#define xmlStopParser hn_libxml_functions.xmlStopParser
#define xmlUnlinkNode hn_libxml_functions.xmlUnlinkNode
#endif
#endif
