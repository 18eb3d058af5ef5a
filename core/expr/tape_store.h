// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_EXPR_TAPE_STORE_H
#define HN_EXPR_TAPE_STORE_H
// The tapes of a graph. A run, its samples, its pilot run and its error estimate ask for the same
// outputs; a node is never freed and never changes, so equal outputs are the same code. Compiling
// them again takes longer than many a short run.

#include "expr/tape.h"

/// All tapes that have been compiled from one graph.
typedef struct hn_tape_store hn_tape_store;

/// The key of a tape: outputs and inputs, in their order. Tapes with equal keys are equal.
typedef struct hn_tape_key {
    const hn_ex *outputs;
    int n_out;
    const int *symbols;
    int n_sym;
} hn_tape_key;

/// Finds the tape of a key: a new one that shares its code, owned, without native state. *out is
/// NULL where there is none. Fails: HN_ERR_MEMORY.
HN_MUST_CHECK hn_status hn_tape_store_find(const hn_tape_store *store, const hn_tape_key *key,
                                           hn_tape **out);
/// Keeps a compiled tape under its key, and makes the store where *store is NULL. The store shares
/// the code with the tape, which stays the caller's. Fails: HN_ERR_MEMORY; nothing is kept then.
HN_MUST_CHECK hn_status hn_tape_store_keep(hn_tape_store **store, const hn_tape_key *key,
                                           hn_tape *tape);
/// Frees the store; tapes that share its code go on. NULL is legal.
void hn_tape_store_free(hn_tape_store *store);
#endif
