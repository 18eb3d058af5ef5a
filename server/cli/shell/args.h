// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef HN_CLI_ARGS_H
#define HN_CLI_ARGS_H
// The words and options behind a command: one table of options for all commands.

#include "base/diag.h"
#include "base/strbuf.h"
#include "cli/shell/command.h"

#include <cjson/cJSON.h>
#include <stdbool.h>

enum { HN_CLI_MAX_WORDS = 256 };

/// A list of words as typed.
typedef struct hn_words {
    int n;
    const char *word[HN_CLI_MAX_WORDS];
} hn_words;

typedef struct hn_numbers {
    int n;
    double *value; ///< owned
} hn_numbers;

/// Options of all commands; a command reads those it lists. Numbers that were not given are NaN,
/// texts NULL.
typedef struct hn_args {
    const hn_command *command; ///< borrowed: whose options these are
    hn_words words;            ///< what is neither command nor option
    hn_words given;            ///< names of the options that were typed, without the hyphens
    hn_words set;              ///< each parameter once
    hn_words set_over_set;     ///< by the program itself: stronger than `set`
    hn_words methods, traces, state_q, state_v, allow_hosts, proxies;
    hn_numbers at;
    const char *method, *format, *language, *out, *host, *theme, *renderer, *view, *loops, *key,
        *grid, *plots, *size, *keys, *runs, *token, *programs, *student, *seeds, *rubric, *shard,
        *style, *pictures, *solver;
    double time, jobs, answer_time, every, t, port, width, height, seed, frame_dt, frames;
    double animate, hint, history, max_comparisons, max_streams, max_connections, run_cpu,
        idle_pause, expiry, keep_alive;
    int guests;
    int json, csv, wide, allow_programs, trust_programs, open, help, raw_lambda, reactions;
    int once, ascii, blocks, plot, check, no_native, show_expected, no_pictures, force;
    int ghosts, dimensions, forces, describe;
    int blanks, merge;
    cJSON *fields; ///< of the command's kinds of jobs, by name; owned; NULL: none was given
} hn_args;

/// Parses what follows the command's name. HN_ERR_INPUT with a near miss in diag. hn_args_reset()
/// afterwards in any case.
HN_MUST_CHECK hn_status hn_args_parse(hn_args *args, const hn_command *command, int argc,
                                      char **argv, hn_diag *diag);
void hn_args_reset(hn_args *args);
/// One option as help, manual and completion show it; argument NULL: a flag.
typedef struct hn_option_row {
    char name[32];
    const char *argument, *about;
    char choices[128]; ///< what its value may be for this command, "csv|json"; "": anything
} hn_option_row;
/// The i-th option that a command reads; false: there are no more.
bool hn_args_option(const hn_command *command, int i, hn_option_row *out);
/// A finite number and nothing behind it; 0 otherwise.
int hn_number_parse(const char *text, double *out);
#endif
