// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/shell/cli_option.h"

#include "cli/shell/args.h"

#include <stddef.h>
#include <string.h>

#define AT(field) offsetof(hn_args, field)

static const hn_cli_option OPTIONS[] = {
    {"--json", NULL, HN_CLI_FLAG, AT(json), "one JSON object on standard output"},
    {"--help", NULL, HN_CLI_FLAG, AT(help), "this help"},
    {"--wide", NULL, HN_CLI_FLAG, AT(wide),
     "do not fold or shorten tables and lines to the terminal's width"},
    {"--allow-programs", NULL, HN_CLI_FLAG, AT(allow_programs),
     "methods may be programs of your own, program:FILE[@INTEGRATOR], run in a sandbox"},
    {"--trust-programs", NULL, HN_CLI_FLAG, AT(trust_programs),
     "like --allow-programs, without a sandbox: only for programs that you trust"},
    {"--answer-time", "S", HN_CLI_NUMBER, AT(answer_time),
     "longest time for one answer of a program [s]; 5 when left out; the first answer may take six "
     "times as long, and at least 20 s"},
    {"--programs", "DIR", HN_CLI_TEXT, AT(programs),
     "methods may be programs of this folder, program:NAME, run in a sandbox"},
    {"--no-native", NULL, HN_CLI_FLAG, AT(no_native),
     "do not compile equations to machine code in the background; HOLONOM_NATIVE=0 does the same"},
    {"--set", "NAME=VALUE", HN_CLI_WORD, AT(set),
     "change a parameter of the scene, or with start.NAME the start value of a coordinate or rate; "
     "may be repeated"},
    {"--method", "METHOD", HN_CLI_TEXT, AT(method),
     "FORMULATION[:key=value,...] @INTEGRATOR[:key=value,...], without the blank"},
    {"--methods", "METHOD...", HN_CLI_WORDS, AT(methods),
     "methods, separated by blanks; the scene's own when left out"},
    {"--time", "T", HN_CLI_NUMBER, AT(time), "end of the run [s]; the scene's when left out"},
    {"--at", "T1,T2,...", HN_CLI_NUMBERS, AT(at), "output times, ascending [s]"},
    {"--every", "DT", HN_CLI_NUMBER, AT(every),
     "output interval [s]; 200 samples when neither --at nor --every is given"},
    {"--reactions", NULL, HN_CLI_FLAG, AT(reactions),
     "add the reactions of every joint and constraint: forces [N] and moments [N m] in world axes, "
     "and efforts along coordinates. The reaction of a joint acts from the parent on the child and "
     "includes the drives and loads along its coordinates; that of a distance acts on the body of "
     "'to', that of a line, plane or wheel on the guided body"},
    {"--raw-lambda", NULL, HN_CLI_FLAG, AT(raw_lambda),
     "add a column raw_lambda: the multipliers that the method itself computes, if it does"},
    {"--format", "FORMAT", HN_CLI_TEXT, AT(format), "form of the output"},
    {"--t", "T", HN_CLI_NUMBER, AT(t),
     "tui: time of the frame [s]. terms: the time t in formulas [s]; the mechanism stays at its "
     "start. snapshot: the same as --time"},
    {"--q", "NAME=VALUE...", HN_CLI_WORDS, AT(state_q),
     "coordinates that differ from the assembled start"},
    {"--v", "NAME=VALUE...", HN_CLI_WORDS, AT(state_v),
     "rates that differ from the assembled start"},
    {"--language", "NAME", HN_CLI_TEXT, AT(language), "language of the program"},
    {"--out", "FILE", HN_CLI_TEXT, AT(out),
     "file to write; an old FILE with other contents is kept as FILE.1"},
    {"-o", "FILE", HN_CLI_TEXT, AT(out), "the same as --out"},
    {"--force", NULL, HN_CLI_FLAG, AT(force), "replace an existing file"},
    {"--loops", "FILE", HN_CLI_TEXT, AT(loops),
     "second file, in JSON, for the parts that a URDF cannot hold: joints that close loops, "
     "gravity, the start"},
    {"--key", "NAME", HN_CLI_TEXT, AT(key),
     "MJCF: the keyframe to start from; the first when left out, qpos0 for none"},
    {"--frame", "DT", HN_CLI_NUMBER, AT(frame_dt),
     "time between two comparisons of the states [s]; chosen when left out"},
    {"--grid", "NxM", HN_CLI_TEXT, AT(grid),
     "columns and rows of a map, as 24x16; when left out, 24x24, or 16x16 without --preset"},
    {"--plots", "DIR", HN_CLI_TEXT, AT(plots),
     "a folder for every plot of the report, as SVG and PNG"},
    {"--csv", NULL, HN_CLI_FLAG, AT(csv), "write CSV to standard output, one row for each point"},
    {"--width", "PIXELS", HN_CLI_COUNT, AT(width), "width of the picture"},
    {"--height", "PIXELS", HN_CLI_COUNT, AT(height), "height of the picture"},
    {"--plot", NULL, HN_CLI_FLAG, AT(plot), "draw plots in characters instead of printing numbers"},
    {"--size", "COLUMNSxROWS", HN_CLI_TEXT, AT(size),
     "size of the frame as text; 80x24 when left out"},
    {"--keys", "KEYS", HN_CLI_TEXT, AT(keys),
     "keys pressed before the frame of --once: characters, and names such as <Enter> or <Down>"},
    {"--once", NULL, HN_CLI_FLAG, AT(once), "print one frame as text, at the time --t"},
    {"--frames", "N", HN_CLI_COUNT, AT(frames), "end after N pictures (text in a pipe)"},
    {"--ascii", NULL, HN_CLI_FLAG, AT(ascii), "ASCII characters only"},
    {"--pictures", "auto|kitty|sixel|off", HN_CLI_TEXT, AT(pictures),
     "how the mechanism is drawn: as a picture by kitty graphics or sixels, or in characters; auto "
     "asks the terminal"},
    {"--blocks", NULL, HN_CLI_FLAG, AT(blocks), "draw with quadrant blocks instead of braille"},
    {"--ghosts", NULL, HN_CLI_FLAG, AT(ghosts),
     "draw all times of --at in one picture, the earlier ones pale"},
    {"--animate", "MS", HN_CLI_NUMBER, AT(animate),
     "animated PNG of the times of --at; each is shown for MS milliseconds"},
    {"--trace", "POINT", HN_CLI_WORD, AT(traces),
     "draw the path of a point by its name; may be repeated"},
    {"--dimensions", NULL, HN_CLI_FLAG, AT(dimensions),
     "draw the lengths of bars and ground, and the angles of joints"},
    {"--forces", NULL, HN_CLI_FLAG, AT(forces), "draw the forces in the joints [N]"},
    {"--describe", NULL, HN_CLI_FLAG, AT(describe),
     "print the contents of the picture as JSON: in words, and as a list of everything drawn"},
    {"--theme", "light|dark", HN_CLI_TEXT, AT(theme),
     "light or dark background; the workbench asks the terminal when left out"},
    {"--renderer", "auto|osmesa|built-in", HN_CLI_TEXT, AT(renderer),
     "program part that paints a PNG; auto takes OSMesa where it is installed. Vector graphics "
     "need "
     "none"},
    {"--view", "front|side|top|space|A,E", HN_CLI_TEXT, AT(view),
     "direction of view; A,E: azimuth and elevation in degrees, as in 35,22"},
    {"--jobs", "N", HN_CLI_COUNT, AT(jobs),
     "number of processes that grade at once; one for each processor when left out"},
    {"--shard", "I/N", HN_CLI_TEXT, AT(shard),
     "grade only every N-th submission, beginning with the I-th"},
    {"--merge", NULL, HN_CLI_FLAG, AT(merge), "put together the parts that --shard wrote"},
    {"--style", "full|skeleton", HN_CLI_TEXT, AT(style),
     "skeleton: only the functions, without the self-check; full when left out"},
    {"--solver", "scipy|petsc|own|eigen|ejml|ode45|ode15s", HN_CLI_TEXT, AT(solver),
     "scipy or petsc (python), own or eigen (cpp), own or ejml (java), ode45 or ode15s (octave)"},
    {"--blanks", NULL, HN_CLI_FLAG, AT(blanks),
     "leave the functions mass, force, jacobian and bias empty for students to fill in; 'grade' "
     "takes the file"},
    {"--seed", "N", HN_CLI_COUNT, AT(seed),
     "variant of the exercise: it sets the numbers and the states at which answers are compared"},
    {"--student", "NAME", HN_CLI_TEXT, AT(student),
     "name of the student, from which the seed of the variant is made"},
    {"--seeds", "A..B", HN_CLI_TEXT, AT(seeds),
     "the variants that --check tries; 1..20 when left out"},
    {"--check", NULL, HN_CLI_FLAG, AT(check),
     "test the exercise: compute references in two ways, grade right answers and known mistakes"},
    {"--rubric", "FILE", HN_CLI_TEXT, AT(rubric),
     "file with a teacher's points, tolerances, shares and costs of hints: see 'rubric write'"},
    {"--show-expected", NULL, HN_CLI_FLAG, AT(show_expected),
     "put the right answers into the verdicts: for teachers, not for students"},
    {"--no-pictures", NULL, HN_CLI_FLAG, AT(no_pictures), "draw no pictures"},
    {"--hint", "N", HN_CLI_COUNT, AT(hint), "print the first N hints"},
    {"--host", "ADDRESS", HN_CLI_TEXT, AT(host),
     "address on which the server listens; 127.0.0.1 when left out"},
    {"--port", "N", HN_CLI_COUNT, AT(port), "8080 when left out; 0: any free port"},
    {"--allow-host", "NAME", HN_CLI_WORD, AT(allow_hosts),
     "another host name that the server accepts; may be repeated"},
    {"--proxy", "ADDRESS", HN_CLI_WORD, AT(proxies),
     "address of a proxy that names its clients in X-Forwarded-For, or a network such as "
     "10.0.0.0/8; one on this machine is believed without it; may be repeated"},
    {"--open", NULL, HN_CLI_FLAG, AT(open), "open the page in a browser"},
    {"--history", "N", HN_CLI_COUNT, AT(history),
     "number of events that are kept for each comparison"},
    {"--max-comparisons", "N", HN_CLI_COUNT, AT(max_comparisons),
     "largest number of comparisons at once"},
    {"--max-streams", "N", HN_CLI_COUNT, AT(max_streams), "largest number of open event streams"},
    {"--max-connections", "N", HN_CLI_COUNT, AT(max_connections), "largest number of connections"},
    {"--token", "TEXT", HN_CLI_TEXT, AT(token),
     "token that clients must send; made and printed where --host is not this machine; none: no "
     "token"},
    {"--guests", NULL, HN_CLI_FLAG, AT(guests), "allow reading without the token"},
    {"--runs", "DIR", HN_CLI_TEXT, AT(runs),
     "a folder in which finished runs and unfinished studies are kept"},
    {"--run-cpu", "S", HN_CLI_NUMBER, AT(run_cpu),
     "largest computing time of one long request [s]"},
    {"--idle-pause", "S", HN_CLI_NUMBER, AT(idle_pause),
     "a comparison without a reader pauses after this long [s]"},
    {"--expiry", "S", HN_CLI_NUMBER, AT(expiry),
     "a comparison nobody touched is deleted after this long [s]"},
    {"--keep-alive", "S", HN_CLI_NUMBER, AT(keep_alive),
     "time between comment lines on a stream without events [s]"},
};
enum { N_OPTIONS = sizeof OPTIONS / sizeof *OPTIONS };
_Static_assert((int)N_OPTIONS <= (int)HN_CLI_MAX_OPTIONS, "a list of all options must hold them");

const hn_cli_option *hn_cli_option_at(int i) {
    return i < N_OPTIONS ? &OPTIONS[i] : NULL;
}

const char *hn_cli_option_listed(const char *list, const char *name) {
    const size_t n = strlen(name);
    for (const char *p = list; *p;) {
        if (strcspn(p, " =") == n && memcmp(p, name, n) == 0) {
            return p + n;
        }
        p += strcspn(p, " ");
        p += strspn(p, " ");
    }
    return NULL;
}

bool hn_cli_option_is_offered(const hn_command *command, const hn_cli_option *o) {
    return strcmp(o->name, "--json") == 0 || strcmp(o->name, "--help") == 0 ||
           strcmp(o->name, "--no-native") == 0 || hn_cli_option_listed(command->options, o->name);
}

bool hn_cli_option_is_shown(const hn_command *command, const hn_cli_option *o) {
    const bool drawn = strcmp(command->name, "tui") == 0 && strcmp(o->name, "--json") == 0;
    return hn_cli_option_is_offered(command, o) && !drawn;
}

/// Another spelling of an option: the results of a class are one JSON object a line.
static const char ONE_A_LINE[] = "--ndjson";

const hn_cli_option *hn_cli_option_find(const hn_command *command, const char *name, size_t n) {
    if (strcmp(command->name, "grade") == 0 && n == strlen(ONE_A_LINE) &&
        memcmp(name, ONE_A_LINE, n) == 0) {
        return hn_cli_option_find(command, "--json", strlen("--json"));
    }
    for (int i = 0; i < N_OPTIONS; i++) {
        if (strlen(OPTIONS[i].name) == n && memcmp(OPTIONS[i].name, name, n) == 0 &&
            hn_cli_option_is_offered(command, &OPTIONS[i])) {
            return &OPTIONS[i];
        }
    }
    return NULL;
}

/// The options for one method and for several: each stands for the other where a command has one of
/// them alone.
static const char *const METHOD_OPTIONS[] = {"--method", "--methods"};

const hn_cli_option *hn_cli_option_find_twin(const hn_command *command, const char *name,
                                             size_t n) {
    for (int i = 0; i < 2; i++) {
        const char *other = METHOD_OPTIONS[1 - i];
        if (strlen(METHOD_OPTIONS[i]) == n && memcmp(METHOD_OPTIONS[i], name, n) == 0) {
            return hn_cli_option_find(command, other, strlen(other));
        }
    }
    return NULL;
}
