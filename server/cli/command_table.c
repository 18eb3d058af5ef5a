// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_table.h"

#include "cli/shell/commands.h"
#include "session/job/job_request.h"

#include <string.h>

#define MODEL_OPTIONS "--set"

static const hn_command COMMANDS[] = {
    {"serve", "", "the page and the API, for this machine alone unless --host says more",
     "--host --port --programs --answer-time --allow-host --open --history --max-comparisons "
     "--max-streams "
     "--max-connections --runs --token --guests --run-cpu "
     "--idle-pause "
     "--expiry --keep-alive",
     0, 0, hn_command_serve},
    {"tui", "[SCENE|LINK]", "the workbench in this terminal: mechanism, plots, verdicts, studies",
     MODEL_OPTIONS
     " --methods --once --t --keys --frames --size --ascii --blocks --pictures --theme",
     0, 1, hn_command_tui},
    {"list", "scenes|methods|lessons|problems", "names what there is, with a line on each",
     "--wide", 1, 1, hn_command_list},
    {"inspect", "SCENE", "degrees of freedom, loops, rank, and how the equations are solved",
     MODEL_OPTIONS " --wide", 1, 1, hn_command_inspect},
    {"equations", "SCENE", "the equations of motion (--format text, latex or json)",
     MODEL_OPTIONS " --format=text|latex|json --wide", 1, 1, hn_command_equations},
    {"export", "SCENE",
     "the mechanism as a program that checks itself: --language python, c, cpp, java, octave, "
     "julia, wolfram or modelica (for Julia, Wolfram and Modelica the equations are tested, but no "
     "exported program was run); latex: its equations to read; or as a model: --format mjcf or "
     "urdf",
     MODEL_OPTIONS
     " --language=python|c|cpp|java|octave|julia|wolfram|modelica|latex --method --style --solver "
     "--blanks --format=mjcf|urdf --loops --out -o --force",
     1, 1, hn_command_export},
    {"program", "python|javascript|octave|c|cpp|java|julia",
     "a starting point for a solver of your own, run as program:FILE; the one in Python needs "
     "numpy",
     "--out -o --force", 1, 1, hn_command_program},
    {"terms", "SCENE", "M, f, J, gamma, accelerations and multipliers at one state",
     MODEL_OPTIONS " --t --q --v --reactions --wide", 1, 1, hn_command_terms},
    {"run", "SCENE", "one method; samples as --format csv, ndjson or json, with a verdict",
     MODEL_OPTIONS " --allow-programs --trust-programs --answer-time --method --time --at --every "
                   "--raw-lambda --reactions --format=csv|ndjson|json --plot",
     1, 1, hn_command_run},
    {"compare", "SCENE", "several methods at the same times: which are right, what they cost",
     MODEL_OPTIONS
     " --allow-programs --trust-programs --answer-time --methods --time --frame --plot --wide",
     1, 1, hn_command_compare},
    {"study", "SCENE work-precision|budget|stability",
     "error against cost, where an error comes from, where steps are stable; --out FILE.html, "
     ".json or .csv (maps also .svg, .png)",
     MODEL_OPTIONS " --allow-programs --trust-programs --answer-time --methods --time --grid --csv "
                   "--out -o --plot --wide",
     1, 2, hn_command_study},
    {"report", "[SCENE...]",
     "studies of several scenes, error budgets and survival in one page; --out FILE.html or .json",
     "--methods --out -o --plots --wide", 0, HN_JOB_SCENES, hn_command_report},
    {"reference", "SCENE",
     "the reference solution, computed in two independent ways, with the digits on which they "
     "agree; --out writes it in the format of the shipped files",
     MODEL_OPTIONS " --time --out -o --wide", 1, 1, hn_command_reference},
    {"merge", "PART...",
     "the parts of a study (study --shard) put together, as if it had been one run",
     "--csv --out -o --wide", 1, HN_CLI_MAX_WORDS, hn_command_merge},
    {"extreme", "[ID...]",
     "cases in which methods break, predicted and observed; --out FILE.html, .json or .csv",
     "--csv --out -o --wide", 0, HN_CLI_MAX_WORDS, hn_command_extreme},
    {"snapshot", "SCENE|ID",
     "draws a scene after a run, or an exercise with the numbers of --seed or --student; PNG or "
     "SVG by the ending of -o",
     MODEL_OPTIONS
     " --allow-programs --trust-programs --answer-time --method --methods --time "
     "--at --ghosts --animate --trace --dimensions --forces --describe --out -o --width "
     "--height --theme --view --seed --student",
     1, 1, hn_command_snapshot},
    {"import", "FILE",
     "convert a MuJoCo MJCF or URDF file to a scene; unsupported elements are listed with their "
     "lines",
     "--out -o --loops --key", 1, 1, hn_command_import},
    {"lesson", "N|ID", "a lesson to read: text, formulas, what to try, exercises", "--wide", 1, 1,
     hn_command_lesson},
    {"problem", "ID|FILE",
     "an exercise with the numbers of a variant; --check proves it over --seeds A..B; --out "
     "FILE.svg writes the plot that is to be read",
     "--seed --student --hint --seeds --check --wide --out -o", 1, 1, hn_command_problem},
    {"grade", "ID SUBMISSION...|FOLDER",
     "verdicts (SUBMISSION - is standard input) as --format text, json, gradescope, prairielearn, "
     "autolab, coderunner, lti-score, "
     "junit, csv or html; into --out DIR. A folder is a class: a folder, file or zip for each "
     "student, whose name chooses the variant unless --seed does; --out FILE.ndjson or .csv. ID is "
     "an exercise, or a scene whose program (export --blanks) was filled in",
     MODEL_OPTIONS
     " --format=text|json|gradescope|prairielearn|autolab|coderunner|lti-score|junit|csv|html "
     "--out -o --seed --student --rubric --plot --show-expected --no-pictures "
     "--wide --jobs --shard --merge",
     2, HN_CLI_MAX_WORDS, hn_command_grade},
    {"rubric", "check|write FILE|ID",
     "check a rubric and say what it means, or write an exercise's own as a start",
     "--out -o --force", 2, 2, hn_command_rubric},
    {"regrade", "VERDICT [SUBMISSION]", "grade again what a verdict (JSON) says, and compare",
     "--rubric", 1, 2, hn_command_regrade},
    {"manual", "", "the manual page in roff, for 'man -l -'", "", 0, 0, NULL},
    {"completion", "bash|zsh|fish", "what a shell needs to complete commands of this program", "",
     1, 1, NULL},
    {"help", "[COMMAND|words|TERM...]",
     "this text, a command's options, or what the terms of messages and tables mean: all, or one",
     "", 0, HN_CLI_MAX_WORDS, NULL},
    {"version", "", "what this program is", "", 0, 0, NULL},
};
enum { N_COMMANDS = sizeof COMMANDS / sizeof *COMMANDS };

int hn_command_count(void) {
    return N_COMMANDS;
}

const hn_command *hn_command_at(int i) {
    return &COMMANDS[i];
}

const hn_command *hn_command_find(const char *name) {
    for (int i = 0; i < N_COMMANDS; i++) {
        if (strcmp(COMMANDS[i].name, name) == 0) {
            return &COMMANDS[i];
        }
    }
    return NULL;
}
