#ifndef HN_CLI_CLI_H
#define HN_CLI_CLI_H
// The command line: one table of commands, one table of options. Results go to standard output, everything else to standard error.

#include "base/diag.h"
#include "base/strbuf.h"
#include "scene/scene.h"
#include "session/model/library.h"
#include "session/model/model.h"

enum { HN_CLI_MAX_WORDS = 256 };

/// Exit statuses: the same everywhere.
typedef enum hn_exit {
    HN_EXIT_DONE = 0,    ///< also a wrong answer that was graded low
    HN_EXIT_INPUT = 2,   ///< the input is at fault
    HN_EXIT_PROGRAM = 3, ///< the program is at fault
    HN_EXIT_ENDED = 4    ///< a run ended early and said why
} hn_exit;

/// A list of words as typed.
typedef struct hn_words {
    int n;
    const char *word[HN_CLI_MAX_WORDS];
} hn_words;

typedef struct hn_numbers {
    int n;
    double *value; ///< owned
} hn_numbers;

/// Options of all commands; a command reads those it lists. Numbers that were not given are NaN, texts NULL.
typedef struct hn_args {
    hn_words words; ///< what is neither command nor option
    hn_words given; ///< names of the options that were given, as in the table
    hn_words set, methods, state_q, state_v, allow_hosts;
    hn_numbers at;
    const char *method, *format, *out, *host, *theme, *view, *loops, *key, *shard, *over, *preset,
        *grid, *plots;
    double time, every, t, port, width, height, seed, frame_dt;
    double budget, levels, samples;
    double history, max_comparisons, max_streams, run_cpu, idle_pause, expiry, keep_alive;
    int again, hold;
    int json, csv, open, help, raw_lambda, reactions, run_long;
} hn_args;

typedef struct hn_command {
    const char *name, *words, *about; ///< words: as in the usage line, "SCENE"
    const char *options;              ///< names, separated by spaces
    int min_words, max_words;
    hn_exit (*run)(const hn_library *lib, const hn_args *args);
} hn_command;

int hn_command_count(void);
const hn_command *hn_command_at(int i);

/// Runs the program; returns its exit status.
int hn_cli_main(int argc, char **argv);

/// Parses what follows the command's name. HN_ERR_INPUT with a near miss in diag. hn_args_reset() afterwards in any case.
HN_MUST_CHECK hn_status hn_args_parse(hn_args *args, const hn_command *command, int argc,
                                      char **argv, hn_diag *diag);
void hn_args_reset(hn_args *args);
/// "--set NAME=VALUE   a parameter that differs ...", a line an option of the command.
void hn_args_describe(hn_strbuf *b, const hn_command *command);
/// HN_ERR_INPUT when an option was given that is not one of `options` (separated by spaces): `whose` does not read it.
HN_MUST_CHECK hn_status hn_args_allow_only(const hn_args *args, const char *options,
                                           const char *whose, hn_diags *diags);
/// A finite number and nothing behind it; 0 otherwise.
int hn_number_parse(const char *text, double *out);

// reporting
/// Tells the faults: sentences on standard error, or with --json one object on standard output. Returns the exit status that fits.
hn_exit hn_report_diags(const hn_args *args, hn_status status, const hn_diags *diags);
hn_exit hn_report_diag(const hn_args *args, const hn_diag *diag);
/// Prints and frees the buffer's text with a newline at its end; HN_EXIT_PROGRAM when memory or the output failed.
hn_exit hn_cli_print(hn_strbuf *text);
/// The same for text that people read: in ASCII characters where the locale has no UTF-8.
hn_exit hn_cli_print_text(hn_strbuf *text);
/// The same into a file; "-" or NULL is standard output.
hn_exit hn_cli_write_file(const hn_args *args, const char *path, hn_strbuf *bytes);
/// Before a computation of minutes whose result goes to `path` (NULL: nowhere): HN_ERR_IO where its folder is not there or
/// takes no files.
HN_MUST_CHECK hn_status hn_cli_check_folder(const char *path, hn_diags *diags);

/// A line on standard error for what takes longer than a second, only if that is a terminal. Zeroed to begin with.
typedef struct hn_progress {
    double started, last;
    double begun,
        first; ///< when the share began to rise, and from where: work taken up from before took no time now
    int shown;
} hn_progress;
void hn_progress_tell(hn_progress *p, const char *what, double share);
void hn_progress_end(hn_progress *p);

// scenes
/// Loads the scene of a word: a shipped name, a file, or "-", with the settings of --set.
HN_MUST_CHECK hn_status hn_args_load_model(const hn_library *lib, const hn_args *args,
                                           const char *word, int allow_open, hn_model **out,
                                           hn_diags *diags);
/// NAME=VALUE, several per word when separated by commas. `see` gets each. pointer names the option for messages.
typedef hn_status (*hn_see_assignment)(void *user, const char *name, double value);
HN_MUST_CHECK hn_status hn_assignments_read(const hn_words *words, const char *option,
                                            hn_see_assignment see, void *user, hn_diags *diags);

// commands
hn_exit hn_command_list(const hn_library *lib, const hn_args *args);
hn_exit hn_command_inspect(const hn_library *lib, const hn_args *args);
hn_exit hn_command_terms(const hn_library *lib, const hn_args *args);
hn_exit hn_command_equations(const hn_library *lib, const hn_args *args);
hn_exit hn_command_run(const hn_library *lib, const hn_args *args);
hn_exit hn_command_compare(const hn_library *lib, const hn_args *args);
hn_exit hn_command_reference(const hn_library *lib, const hn_args *args);
hn_exit hn_command_report(const hn_library *lib, const hn_args *args);
hn_exit hn_command_merge(const hn_library *lib, const hn_args *args);
hn_exit hn_command_study(const hn_library *lib, const hn_args *args);
hn_exit hn_command_extreme(const hn_library *lib, const hn_args *args);
hn_exit hn_command_snapshot(const hn_library *lib, const hn_args *args);
hn_exit hn_command_problem(const hn_library *lib, const hn_args *args);
hn_exit hn_command_grade(const hn_library *lib, const hn_args *args);
hn_exit hn_command_import(const hn_library *lib, const hn_args *args);
hn_exit hn_command_serve(const hn_library *lib, const hn_args *args);
#endif
