// SPDX-License-Identifier: GPL-3.0-or-later
#include "http/routes/openapi_schemas.h"

#include "base/status.h"

// ---- schemas of answers ----

#define NUMBERS "{\"type\":\"array\",\"items\":{\"type\":\"number\"}}"
#define MAYBE_NUMBER "{\"type\":[\"number\",\"null\"]}"
#define TEXTS "{\"type\":\"array\",\"items\":{\"type\":\"string\"}}"
/// An array for each time; null where there is none.
#define ROWS "{\"type\":\"array\",\"items\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER "}}"
#define TEXT "{\"type\":\"string\"}"
#define ESTIMATE                                                                                   \
    "{\"type\":\"object\",\"description\":\"relative errors against a pilot run, the "             \
    "largest up to t; null where not known, reason says why. q is that of a coordinate, which is " \
    "off by so much in its unit\",\"properties\":{\"q\":" MAYBE_NUMBER ",\"coordinate\":" TEXT     \
    ",\"off\":" MAYBE_NUMBER ",\"unit\":" TEXT ",\"v\":" MAYBE_NUMBER                              \
    ",\"reaction\":" MAYBE_NUMBER ",\"own\":" MAYBE_NUMBER ",\"t\":" MAYBE_NUMBER                  \
    ",\"over_rtol\":" MAYBE_NUMBER ",\"reason\":" TEXT "}}"
#define STATUS_NAME(value, name, text) ",\"" name "\""
#define STATUS "{\"enum\":[\"ok\"" HN_STATUS_FAILURES(STATUS_NAME) "]}"
#define FAILURE "{\"oneOf\":[{\"$ref\":\"#/components/schemas/Failure\"},{\"type\":\"null\"}]}"
#define OBJECTS "{\"type\":\"array\",\"items\":{\"type\":\"object\"}}"

static const struct {
    const char *name, *schema;
} SCHEMAS[] = {
    {"Text", "{\"type\":\"string\"}"},
    {"Failure",
     "{\"type\":\"object\",\"description\":\"why a run or a method ended early, as data; null "
     "where "
     "it did not. reason, beside it, is the same as one sentence for people, and equals message\","
     "\"required\":[\"code\",\"quantity\",\"value\",\"limit\",\"t\",\"message\",\"remedies\"],"
     "\"properties\":{\"code\":" TEXT
     ",\"quantity\":{\"type\":[\"string\",\"null\"]},\"value\":" MAYBE_NUMBER
     ",\"limit\":" MAYBE_NUMBER ",\"t\":{\"type\":\"number\"},\"message\":" TEXT
     ",\"remedies\":" TEXTS "}}"},
    {"RunList",
     "{\"type\":\"object\",\"required\":[\"runs\",\"spoilt\",\"unchecked\"],\"properties\":{"
     "\"runs\":" TEXTS
     ",\"spoilt\":{\"type\":\"integer\",\"description\":\"files that are not whole\"},"
     "\"unchecked\":{\"type\":\"integer\",\"description\":\"files that there was no time to "
     "read\"}}}"},
    {"Samples",
     "{\"type\":\"object\",\"required\":[\"fields\",\"rows\",\"next_cursor\"],\"properties\":{"
     "\"fields\":" TEXTS
     ",\"rows\":{\"type\":\"array\",\"items\":{\"type\":\"array\",\"items\":{}}},"
     "\"next_cursor\":{\"type\":[\"integer\",\"null\"]}}}"},
    {"Document", "{\"type\":\"object\"}"},
    {"Health",
     "{\"type\":\"object\",\"required\":[\"status\"],\"properties\":{\"status\":{\"const\":\"ok\"},"
     "\"version\":" TEXT ",\"build\":" TEXT "}}"},
    {"Index", "{\"type\":\"object\",\"required\":[\"name\",\"version\",\"links\",\"limits\","
              "\"routes\",\"incidents\"],\"properties\":{"
              "\"name\":" TEXT ",\"version\":" TEXT ",\"build\":" TEXT
              ",\"links\":{\"type\":\"object\",\"additionalProperties\":" TEXT "},"
              "\"limits\":{\"type\":\"object\",\"additionalProperties\":{\"type\":\"number\"}},"
              "\"routes\":" OBJECTS ",\"incidents\":" OBJECTS "}}"},
    {"Scenes",
     "{\"type\":\"object\",\"required\":[\"scenes\"],\"properties\":{\"scenes\":" OBJECTS "}}"},
    {"Lessons",
     "{\"type\":\"object\",\"required\":[\"lessons\"],\"properties\":{\"lessons\":" OBJECTS "}}"},
    {"Lesson", "{\"type\":\"object\",\"required\":[\"id\",\"number\",\"title\",\"blocks\"],"
               "\"properties\":{\"id\":" TEXT ",\"number\":{\"type\":\"number\"},\"title\":" TEXT
               ",\"scenes\":" TEXTS ",\"problems\":" TEXTS ",\"blocks\":" OBJECTS "}}"},
    {"Problems",
     "{\"type\":\"object\",\"required\":[\"problems\"],\"properties\":{\"problems\":" OBJECTS "}}"},
    {"Scene",
     "{\"type\":\"object\",\"required\":[\"id\",\"title\",\"parameters\",\"coordinates\","
     "\"drawing\"],\"properties\":{"
     "\"id\":" TEXT ",\"title\":" TEXT ",\"parameters\":" OBJECTS ",\"coordinates\":" OBJECTS
     ",\"bodies\":" OBJECTS ",\"joints\":" OBJECTS
     ",\"drawing\":{\"type\":\"object\"},\"points\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER
     "},"
     "\"methods\":" TEXTS ",\"duration\":{\"type\":\"number\"},\"step\":{\"type\":\"number\"}}}"},
    {"Methods",
     "{\"type\":\"object\",\"required\":[\"formulations\",\"integrators\"],\"properties\":{"
     "\"formulations\":" OBJECTS ",\"integrators\":" OBJECTS ",\"programs\":" TEXTS "}}"},
    {"Drag",
     "{\"type\":\"object\",\"required\":[\"scene\",\"reached\",\"end\",\"reason\",\"distance\","
     "\"gap\","
     "\"state\",\"points\"],\"properties\":{\"scene\":" TEXT ",\"reached\":{\"type\":\"boolean\"},"
     "\"end\":{\"enum\":[\"reached\",\"nearest\",\"time\",\"stuck\"]},"
     "\"reason\":{\"type\":[\"string\",\"null\"]},\"distance_before\":{\"type\":\"number\"},"
     "\"distance\":{\"type\":\"number\"},\"gap\":{\"type\":\"number\"},\"steps\":{\"type\":"
     "\"integer\"},"
     "\"cpu_seconds\":{\"type\":\"number\"},\"state\":{\"type\":\"object\",\"description\":\"every "
     "free "
     "coordinate and rate by name\",\"additionalProperties\":{\"type\":\"number\"}},"
     "\"points\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER "}}}"},
    {"Equations", "{\"type\":\"object\",\"properties\":{\"format\":" TEXT ",\"text\":" TEXT "}}"},
    {"Reference",
     "{\"type\":\"object\",\"required\":[\"scene\",\"scene_hash\",\"source\",\"time\",\"means\","
     "\"digits\",\"error\",\"coordinates\",\"t\",\"q\",\"v\",\"lambda\",\"energy\"],"
     "\"properties\":{\"scene\":" TEXT ",\"scene_hash\":" TEXT ",\"source\":" TEXT
     ",\"means\":" TEXTS
     ",\"time\":{\"type\":\"number\"},\"digits\":{\"type\":\"number\"},\"error\":{\"type\":"
     "\"object\"},\"coordinates\":" TEXTS ",\"t\":" NUMBERS ",\"energy\":" NUMBERS ",\"q\":" ROWS
     ",\"v\":" ROWS ",\"lambda\":" ROWS ",\"motion\":{\"type\":\"object\"}}}"},
    {"Run",
     "{\"type\":\"object\",\"required\":[\"id\",\"state\",\"progress\",\"links\"],\"properties\":{"
     "\"id\":" TEXT ",\"state\":{\"enum\":[\"waiting\",\"running\",\"finished\"]},"
     "\"progress\":{\"type\":\"number\"},\"links\":{\"type\":\"object\"},\"runs\":" OBJECTS ","
     "\"scene\":{\"type\":[\"string\",\"null\"]},"
     "\"method\":" TEXT ",\"status\":" STATUS ",\"reason\":" TEXT ",\"failure\":" FAILURE
     ",\"verdict\":{\"type\":\"object\",\"description\":\"verdict on the motion by its error "
     "estimate; status only says whether the run reached its "
     "end\",\"properties\":{\"is\":{\"enum\":[\"right\",\"inaccurate\",\"wrong\",\"unknown\"]},"
     "\"text\":" TEXT "}}"
     ",\"t_reached\":{\"type\":\"number\"},\"coordinates\":" TEXTS ",\"lambda_marks\":" TEXTS ","
     "\"samples\":{\"type\":\"object\",\"properties\":{\"t\":" NUMBERS
     ",\"lambda_mark\":{\"type\":\"array\",\"items\":{\"type\":\"integer\"},\"description\":"
     "\"reliability of the multipliers of each sample, and of the reactions computed from them: an "
     "index into "
     "lambda_marks\"}}},\"incidents\":{\"type\":\"array\",\"items\":{\"$ref\":\"#/components/"
     "schemas/Incident\"}},\"cost\":{\"type\":\"object\"}}}"},
    {"ComparisonList",
     "{\"type\":\"object\",\"required\":[\"comparisons\"],\"properties\":{\"comparisons\":" TEXTS
     "}}"},
    {"Frame",
     "{\"type\":\"object\",\"description\":\"data of the event "
     "frame\",\"required\":[\"generation\",\"frame\",\"t\",\"methods\"],"
     "\"properties\":{\"generation\":{\"type\":\"integer\"},\"frame\":{\"type\":\"integer\"},\"t\":"
     "{\"type\":\"number\"},"
     "\"methods\":{\"type\":\"array\",\"items\":{\"type\":\"object\",\"required\":[\"state\","
     "\"status\"],\"properties\":{"
     "\"state\":{\"enum\":[\"running\",\"finished\",\"failed\"]},\"status\":" STATUS
     ",\"reason\":" TEXT ",\"failure\":" FAILURE ",\"t\":{\"type\":\"number\"},"
     "\"q\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER
     "},\"v\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER "},"
     "\"points\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER "},\"gap\":" MAYBE_NUMBER
     ",\"velocity_gap\":" MAYBE_NUMBER ",\"energy\":" MAYBE_NUMBER ",\"work\":" MAYBE_NUMBER
     ",\"energy_change\":" MAYBE_NUMBER ",\"error_estimate\":" ESTIMATE
     ",\"steps\":{\"type\":\"integer\"},\"evals\":{\"type\":\"integer\"},"
     "\"ops\":" MAYBE_NUMBER ",\"cpu\":" MAYBE_NUMBER "}}},"
     "\"sigma_min\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER
     ",\"description\":\"of each method, when fields asks for it: the smallest singular value of "
     "the constraint rows, scaled by the masses, after the last step\"},"
     "\"lambda\":{\"type\":\"array\",\"items\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER
     "},\"description\":\"of each method, when fields asks for it: multipliers\"},"
     "\"condition\":{\"type\":\"array\",\"items\":" MAYBE_NUMBER
     ",\"description\":\"of each method, when fields asks for it: largest over smallest singular "
     "value of these rows; null without rows, or where the smallest is 0\"}}}"},
    {"Incident",
     "{\"type\":\"object\",\"description\":\"data of the event incident; sent again with the same "
     "method, code and t when its outcome is known; a run lists the first 5 of a code, and times "
     "counts all of them up to then\",\"required\":[\"generation\","
     "\"method\",\"code\",\"t\",\"message\"],\"properties\":{"
     "\"generation\":{\"type\":\"integer\"},\"method\":{\"type\":\"integer\"},\"code\":" TEXT
     ",\"t\":{\"type\":\"number\"},\"quantity\":{\"type\":["
     "\"string\",\"null\"]},\"value\":" MAYBE_NUMBER ",\"limit\":" MAYBE_NUMBER
     ",\"times\":{\"type\":\"integer\"},\"message\":" TEXT ",\"remedies\":" TEXTS
     ",\"tried\":" TEXTS "}}"},
    {"Comparison",
     "{\"type\":\"object\",\"required\":[\"id\",\"state\",\"speed\",\"frame\",\"t\",\"frame_dt\","
     "\"duration\",\"generation\","
     "\"scene\",\"comparison\",\"parameters\",\"latest\",\"links\"],\"properties\":{\"id\":" TEXT
     ",\"state\":{\"enum\":[\"paused\",\"running\",\"finished\"]},\"speed\":{\"type\":\"number\"},"
     "\"frame\":{\"type\":\"integer\"},\"t\":{\"type\":\"number\"},\"frame_dt\":{\"type\":"
     "\"number\"},"
     "\"duration\":{\"type\":\"number\"},\"generation\":{\"type\":\"integer\"},\"lag\":{\"type\":"
     "\"number\"},"
     "\"last_event\":{\"type\":\"integer\"},\"scene\":{\"$ref\":\"#/components/schemas/Scene\"},"
     "\"comparison\":{\"type\":\"object\"},\"parameters\":{\"type\":\"object\","
     "\"additionalProperties\":{\"type\":\"number\"}},"
     "\"latest\":{\"oneOf\":[{\"$ref\":\"#/components/schemas/Frame\"},{\"type\":\"null\"}]},"
     "\"links\":{\"type\":\"object\",\"additionalProperties\":" TEXT "}}}"},
    {"Events",
     "{\"type\":\"string\",\"description\":\"hello (schema, build, description), frame (Frame), "
     "slow (frame, method, slowness, computed_s, detail, hint: this frame takes long, and why), "
     "incident (Incident), "
     "reset (generation, description), state (state, speed), gap (from, to), end (summary), "
     "stopping (detail: the server ends)\"}"},
    {"RunEvents", "{\"type\":\"string\",\"description\":\"hello (schema, build, id), progress "
                  "(state, progress), "
                  "sample (method, the columns), incident (method, Incident), problem (detail: a "
                  "column that the "
                  "run does not have), end (Run without samples; state stopped: it was deleted), "
                  "stopping (detail: the server ends)\"}"},
    {"StudyList",
     "{\"type\":\"object\",\"required\":[\"studies\"],\"properties\":{\"studies\":" OBJECTS "}}"},
    {"Study",
     "{\"type\":\"object\",\"description\":\"document is the one that the command line writes with "
     "--json, and null before the first result; while a stopped study continues, it holds the "
     "earlier results. progress and time_left_s describe the present run of the study, elapsed_s "
     "all of "
     "them\",\"required\":[\"id\",\"kind\",\"state\",\"reason\",\"progress\",\"elapsed_s\",\"time_"
     "left_s\",\"time_limit_s\",\"scene\",\"parameters\",\"methods\",\"document\",\"links\"],"
     "\"properties\":{\"id\":" TEXT ",\"kind\":" TEXT
     ",\"state\":{\"enum\":[\"running\",\"finished\",\"stopped\",\"failed\"]},\"reason\":" TEXT
     ",\"hint\":" TEXT ",\"progress\":{\"type\":\"number\"},\"elapsed_s\":{\"type\":\"number\"},"
     "\"time_left_s\":" MAYBE_NUMBER ",\"time_limit_s\":{\"type\":\"number\"},\"scene\":{\"type\":["
     "\"string\",\"null\"]},\"parameters\":{\"type\":\"object\",\"additionalProperties\":{\"type\":"
     "\"number\"}},\"methods\":" TEXTS ",\"document\":{\"type\":[\"object\",\"null\"]},\"links\":{"
     "\"type\":\"object\",\"additionalProperties\":" TEXT "}}}"},
    {"Verdict", "{\"type\":\"object\"}"},
    {"Report", "{\"type\":\"string\",\"contentMediaType\":\"text/html\"}"},
    {"Picture", "{\"type\":\"string\",\"contentMediaType\":\"image/png\"}"},
    {"Problem",
     "{\"type\":\"object\",\"description\":\"RFC "
     "9457\",\"required\":[\"type\",\"title\",\"status\",\"detail\"],\"properties\":{"
     "\"type\":" TEXT ",\"title\":" TEXT ",\"status\":{\"type\":\"integer\"},\"detail\":" TEXT
     ",\"hint\":" TEXT ",\"instance\":" TEXT ",\"offset\":{\"type\":\"integer\",\"description\":"
     "\"byte at which the body stops being JSON\"},"
     "\"errors\":{\"type\":\"array\",\"items\":{\"type\":\"object\",\"required\":[\"detail\","
     "\"pointer\"],\"properties\":{"
     "\"detail\":" TEXT ",\"pointer\":" TEXT ",\"hint\":" TEXT
     ",\"column\":{\"type\":\"integer\"}}}}}}"},
};

void hn_openapi_put_schemas(hn_strbuf *b) {
    for (size_t i = 0; i < sizeof SCHEMAS / sizeof *SCHEMAS; i++) {
        hn_json_key(b, SCHEMAS[i].name);
        hn_json_raw(b, SCHEMAS[i].schema);
    }
}
