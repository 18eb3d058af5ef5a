// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_GLOSSARY_H
#define HN_CLI_GLOSSARY_H
// The terms of messages, tables and the workbench in the terminal, each with what it means:
// 'holonom help words'. The page has its own (web/state/glossary.js), with the page's names.

typedef struct hn_term {
    const char *word;  ///< as the messages spell it
    const char *means; ///< one or two sentences
} hn_term;

/// Returns the terms, those of one subject beside each other; *n: how many.
const hn_term *hn_glossary(int *n);
#endif
