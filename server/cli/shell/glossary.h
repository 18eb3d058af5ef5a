// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_GLOSSARY_H
#define HN_CLI_GLOSSARY_H
// The terms of messages, tables and the workbench in the terminal, each with what it means:
// 'holonom help words'. The page has its own (web/state/glossary.js), with the page's names.

#include <stdbool.h>

typedef struct hn_glossary_term {
    const char *word;  ///< as the messages spell it
    const char *means; ///< one or two sentences
} hn_glossary_term;

/// Returns the terms, those of one subject beside each other; *n: how many.
const hn_glossary_term *hn_glossary(int *n);
/// Match of a term with a word, letter case aside, and where several terms do: those of
/// the best kind are meant.
typedef enum hn_term_match {
    HN_TERM_OTHER, ///< it does not
    HN_TERM_TELLS, ///< what it means holds the word, as "dead point"
    HN_TERM_HOLDS, ///< one of its names holds the word, as "violation"
    HN_TERM_IS     ///< the word is one of its names, as "multipliers"
} hn_term_match;
hn_term_match hn_term_matches(const hn_glossary_term *term, const char *word);
/// Returns whether a text holds one of the names of a term that have two letters or more.
bool hn_term_is_in(const hn_glossary_term *term, const char *text);
#endif
