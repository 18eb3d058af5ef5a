// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/command_table.h"

#include "cli/shell/commands.h"
#include "session/job/job_request.h"

#include <string.h>

#define MODEL_OPTIONS "--set"

static const hn_command COMMANDS[] = {
    {"serve", "",
     "serve the workbench as a page and as an API; only this machine can connect unless --host is "
     "given",
     "--host --port --programs --answer-time --allow-host --proxy --open --history "
     "--max-comparisons "
     "--max-streams "
     "--max-connections --runs --token --guests --run-cpu "
     "--idle-pause "
     "--expiry --keep-alive",
     0, 0, hn_command_serve},
    {"tui", "[SCENE|LINK]",
     "open the workbench in this terminal: mechanism, plots, verdicts, studies",
     MODEL_OPTIONS
     " --methods --once --t --keys --frames --size --ascii --blocks --pictures --theme",
     0, 1, hn_command_tui},
    {"list", "scenes|methods [NAME]|lessons|problems",
     "list the scenes, methods, lessons or exercises, with one line on each; with NAME, describe "
     "one formulation or integrator and its settings",
     "--wide", 1, 2, hn_command_list},
    {"inspect", "SCENE", "show degrees of freedom, loops, rank, and how the equations are solved",
     MODEL_OPTIONS " --wide", 1, 1, hn_command_inspect},
    {"equations", "SCENE", "write the equations of motion (--format text, latex or json)",
     MODEL_OPTIONS " --format=text|latex|json --wide", 1, 1, hn_command_equations},
    {"export", "SCENE",
     "write the mechanism as a program that checks itself: --language python, c, cpp, java, "
     "octave, julia, wolfram or modelica (for Julia, Wolfram and Modelica the equations are "
     "tested, but no exported program was run); --language latex writes the equations to read, "
     "--format mjcf or urdf a model for another simulator",
     MODEL_OPTIONS
     " --language=python|c|cpp|java|octave|julia|wolfram|modelica|latex --method --style --solver "
     "--blanks --format=mjcf|urdf --loops --out -o --force",
     1, 1, hn_command_export},
    {"program", "python|javascript|octave|c|cpp|java|julia",
     "write a starting point for a solver of your own, which runs as the method program:FILE@rk4; "
     "the one in Python needs numpy. It answers t, q, v with accelerations, which depend on "
     "t, q and v alone. A program can also step by itself: it says \"provides\": \"step\", is "
     "asked t, h, q, v, answers q, v at t + h, and "
     "runs as program:FILE@own:h=1e-3. server/program/README.md has the format. run and compare "
     "run it with --allow-programs; serve --programs DIR lets the page run the programs in DIR",
     "--out -o --force", 1, 1, hn_command_program},
    {"terms", "SCENE", "print M, f, J, gamma, accelerations and multipliers at one state",
     MODEL_OPTIONS " --t --q --v --reactions --wide", 1, 1, hn_command_terms},
    {"run", "SCENE",
     "run one method; writes samples as --format csv, ndjson or json, and a verdict. A terminal "
     "gets "
     "a table that fits it unless a format is asked for",
     MODEL_OPTIONS " --allow-programs --trust-programs --answer-time --method --time --at --every "
                   "--raw-lambda --reactions --format=csv|ndjson|json --plot --wide",
     1, 1, hn_command_run},
    {"compare", "SCENE", "run several methods side by side: which are right, and what they cost",
     MODEL_OPTIONS
     " --allow-programs --trust-programs --answer-time --methods --time --frame --plot --wide",
     1, 1, hn_command_compare},
    {"study", "SCENE work-precision|budget|stability",
     "measure error against cost, where an error comes from, or which steps are stable; --out "
     "FILE.html, .json or .csv (maps also .svg, .png)",
     MODEL_OPTIONS " --allow-programs --trust-programs --answer-time --methods --time --grid --csv "
                   "--out -o --plot --wide",
     1, 2, hn_command_study},
    {"report", "[SCENE...]",
     "put studies, error budgets and survival of several scenes on one page; --out FILE.html or "
     ".json",
     "--methods --out -o --plots --wide", 0, HN_JOB_SCENES, hn_command_report},
    {"reference", "SCENE",
     "compute the reference solution in two independent ways, with the digits on which they agree; "
     "--out writes it in the format of the shipped files",
     MODEL_OPTIONS " --time --out -o --wide", 1, 1, hn_command_reference},
    {"merge", "PART...",
     "put the parts of a study together that study --shard computed, as if one run had made them",
     "--csv --out -o --wide", 1, HN_CLI_MAX_WORDS, hn_command_merge},
    {"extreme", "[ID...]",
     "run the cases in which methods break, and compare predictions with observations; --out "
     "FILE.html, .json or .csv",
     "--csv --out -o --wide", 0, HN_CLI_MAX_WORDS, hn_command_extreme},
    {"snapshot", "SCENE|ID",
     "draw a scene after a run, or an exercise with the numbers of --seed or --student; the ending "
     "of -o chooses PNG or SVG",
     MODEL_OPTIONS
     " --allow-programs --trust-programs --answer-time --method --methods --time "
     "--at --ghosts --animate --trace --dimensions --forces --describe --out -o --width "
     "--height --theme --renderer --view --seed --student --t",
     1, 1, hn_command_snapshot},
    {"import", "FILE",
     "convert a MuJoCo MJCF or URDF file to a scene; unsupported elements are listed with their "
     "lines",
     "--out -o --loops --key", 1, 1, hn_command_import},
    {"lesson", "N|ID", "print a lesson: text, formulas, what to try, exercises", "--wide", 1, 1,
     hn_command_lesson},
    {"problem", "ID|FILE",
     "print an exercise with the numbers of a variant; --check tests it over --seeds A..B; --out "
     "FILE.svg writes the plot that the exercise asks about; --rubric prints a teacher's points "
     "and tolerances",
     "--seed --student --hint --seeds --check --rubric --wide --out -o", 1, 1, hn_command_problem},
    {"grade", "ID SUBMISSION...|FOLDER",
     "verdicts (SUBMISSION - is standard input) as --format text, json, gradescope, prairielearn, "
     "autolab, coderunner, lti-score, "
     "junit, csv or html; --out DIR/ "
     "writes a file for each. A folder is a class: a folder, file or zip for each "
     "student, whose name chooses the variant unless --seed does; --out FILE.ndjson or .csv. ID is "
     "an exercise, or a scene whose program (export --blanks) was filled in; where both have the "
     "name, scene:ID or exercise:ID says which, and a class is of the exercise. --ndjson prints a "
     "line for each submission as it ends. A class that was interrupted goes on when the same "
     "command is given again. On several machines: --shard I/N for each, then grade ID --merge "
     "PART... --out FILE",
     MODEL_OPTIONS
     " --format=text|json|gradescope|prairielearn|autolab|coderunner|lti-score|junit|csv|html "
     "--out -o --seed --student --rubric --plot --show-expected --no-pictures "
     "--wide --jobs --shard --merge",
     2, HN_CLI_MAX_WORDS, hn_command_grade},
    {"rubric", "check|write FILE|ID [EXERCISE.json]",
     "check a rubric and explain it, or write the exercise's own rubric as a starting point; check "
     "takes the file of an exercise of your own behind the rubric",
     "--out -o --force", 2, 3, hn_command_rubric},
    {"regrade", "VERDICT [SUBMISSION]",
     "grade the submission of a verdict (JSON) again, and compare the scores", "--rubric", 1, 2,
     hn_command_regrade},
    {"manual", "", "write the manual page in roff, for 'man -l -'", "", 0, 0, NULL},
    {"completion", "bash|zsh|fish",
     "write the script with which a shell completes holonom's commands", "", 1, 1, NULL},
    {"help", "[COMMAND|words|TERM...]",
     "show this text, the options of a command, or the meaning of terms in messages and tables", "",
     0, HN_CLI_MAX_WORDS, NULL},
    {"version", "", "print the version of holonom", "", 0, 0, NULL},
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
