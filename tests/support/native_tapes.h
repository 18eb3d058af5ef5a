// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_SUPPORT_NATIVE_TAPES_H
#define HN_SUPPORT_NATIVE_TAPES_H
// Tapes of x, y and z, and the service that compiles them in a folder of its own.

#include "expr/native.h"
#include "expr/tape.h"

enum { HN_NATIVE_INPUTS = 3, HN_NATIVE_STATES = 40 };

/// Where the service keeps what it compiled: made anew for every test.
extern char hn_native_folder[64];

/// Makes the folder, and stops the service and removes the folder: set-up and tear-down of a test.
int hn_native_tapes_set_up(void **state);
int hn_native_tapes_tear_down(void **state);

/// Options that ask for every tape at its first run and compile it at its second. compiler: NULL:
/// the usual one.
hn_native_opts hn_native_eager(const char *compiler);
/// Starts the service with these options.
void hn_native_start_eager(const char *compiler);
/// Runs a small tape until the queue has done what it can. Returns the counts since the start.
hn_native_counts hn_native_run_small(void);

/// A graph with the symbols x, y and z; the caller frees it.
hn_graph *hn_graph_of_xyz(void);
/// Compiles n_out expressions of that graph; stops the test when it fails.
hn_tape *hn_compile_xyz(hn_graph *g, const hn_ex *out, int n_out);
/// Four outputs after n rounds of recurrences: from n = 300 on thousands of instructions, whose
/// values cross from piece to piece.
hn_tape *hn_tape_long(int n);
/// The same after three rounds.
hn_tape *hn_tape_small(void);
/// Writes the outputs at HN_NATIVE_STATES states, corners of the numbers among the first six.
void hn_tape_eval_states(const hn_tape *tape, double *out);

#endif
