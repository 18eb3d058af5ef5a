// SPDX-License-Identifier: GPL-3.0-or-later
#include "grade/submission.h"

#include "grade/repeated_member.h"
#include "grade/student_name.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/// Whole numbers up to 2^53 are exact as doubles.
static const double LARGEST_WHOLE = 9007199254740992.0;

int hn_submission_refuse(hn_verdict *v, const char *hint, const char *format, ...) {
    va_list args;
    va_start(args, format);
    vsnprintf(v->reason, sizeof v->reason, format, args);
    va_end(args);
    snprintf(v->hint, sizeof v->hint, "%s", hint ? hint : "");
    v->kind = HN_VERDICT_UNGRADABLE;
    return 0;
}

void hn_submission_remark(hn_verdict *v, const char *format, ...) {
    va_list args;
    size_t used = strlen(v->note);
    if (used > 0 && used + 2 < sizeof v->note) {
        used += (size_t)snprintf(v->note + used, sizeof v->note - used, "; ");
    }
    va_start(args, format);
    vsnprintf(v->note + used, sizeof v->note - used, format, args);
    va_end(args);
}

static const char *kind_of(const cJSON *node) {
    return cJSON_IsNumber(node)   ? "a number"
           : cJSON_IsString(node) ? "a text"
           : cJSON_IsArray(node)  ? "a list"
           : cJSON_IsObject(node) ? "an object"
           : cJSON_IsNull(node)   ? "null"
                                  : "true or false";
}

void hn_submission_remark_unread(hn_verdict *v, const cJSON *root, const char *const *fields,
                                 int n) {
    char names[160] = "";
    size_t used = 0;
    int count = 0;
    for (const cJSON *m = root->child; m; m = m->next) {
        bool known = false;
        for (int i = 0; i < n; i++) {
            known |= strcmp(m->string, fields[i]) == 0;
        }
        count += !known;

        // as many names as fit
        if (!known && used < sizeof names - 60) {
            used += (size_t)snprintf(names + used, sizeof names - used, "%s'%.50s'",
                                     count > 1 ? ", " : "", m->string);
        } else if (!known && used < sizeof names - 5) {
            used += (size_t)snprintf(names + used, sizeof names - used, ", ...");
        }
    }
    if (count > 0) {
        hn_submission_remark(v, "the field%s %s %s not read", count == 1 ? "" : "s", names,
                             count == 1 ? "was" : "were");
    }
}

void hn_submission_remark_read_as(hn_verdict *v) {
    const hn_entry_verdict *first = NULL;
    int n = 0;
    for (int k = v->n_entries; k-- > 0;) {
        if (v->entry[k].read_as[0]) {
            first = &v->entry[k];
            n++;
        }
    }
    if (first) {
        char more[40] = "";
        if (n > 1) {
            snprintf(more, sizeof more, ", and %d more likewise", n - 1);
        }
        hn_submission_remark(v, "%s was read as %s%s", first->name, first->read_as, more);
    }
}

void hn_submission_remark_nobody(hn_verdict *v) {
    hn_submission_remark(v,
                         "no student and no seed is named: graded with the numbers of the "
                         "exercise itself, seed %llu",
                         (unsigned long long)v->seed);
}

int hn_submission_check_once(hn_verdict *v, const cJSON *root, const char *const *fields) {
    for (; *fields; fields++) {
        if (hn_repeated_member_is(root, *fields)) {
            return hn_submission_refuse(v, "keep the one that counts",
                                        "the field '%s' is there more than once, with different "
                                        "values",
                                        *fields);
        }
    }
    return 1;
}

int hn_submission_read_student(hn_verdict *v, cJSON *root, bool chosen) {
    static const char FIELD[] = "student";
    static const char HINT[] = "write the name or number in quotes, as in \"student\": \"4711\"";
    const cJSON *m = cJSON_GetObjectItemCaseSensitive(root, FIELD);
    const char *text = cJSON_GetStringValue(m);
    if (!m || cJSON_IsNull(m) || (text && (chosen || text[strspn(text, " \t\r\n")]))) {
        return 1;
    }
    if (text) {
        return hn_submission_refuse(v, "put your name into it, or leave it out",
                                    "the field 'student' is an empty text");
    }
    if (!cJSON_IsNumber(m)) {
        return hn_submission_refuse(v, HINT, "the field 'student' is %s, expected a text",
                                    kind_of(m));
    }

    // a whole number that a double holds digit by digit
    const double number = m->valuedouble;
    if (!(number >= 0 && number <= LARGEST_WHOLE && number == floor(number))) {
        return hn_submission_refuse(v, HINT,
                                    "the field 'student' is %.17g, expected a text or a "
                                    "whole number up to %.0f",
                                    number, LARGEST_WHOLE);
    }
    char digits[32];
    snprintf(digits, sizeof digits, "%.0f", number);
    return cJSON_ReplaceItemInObjectCaseSensitive(root, FIELD, cJSON_CreateString(digits));
}

void hn_submission_check_student(hn_verdict *v, const char *name) {
    char own[sizeof v->student], said[sizeof v->student];
    hn_student_name_normalise(name, own, sizeof own);
    hn_student_name_normalise(v->student, said, sizeof said);
    if (said[0] && strcmp(said, own) != 0) {
        hn_submission_refuse(v, "put the right name into \"student\", or leave it out",
                             "the submission says that it is by student '%s', and it was handed "
                             "in by '%s'",
                             said, own);
    }
}

/// Remarks on fields that are not read; refuses the file of another exercise.
static int check_fields(hn_verdict *v, const cJSON *root) {
    const hn_exercise *p = v->problem;
    const char *fields[] = {p->answer, "problem", "student", "seed", "comment", NULL};
    hn_submission_remark_unread(v, root, fields, 5);
    if (!hn_submission_check_once(v, root, fields)) {
        return 0;
    }

    // a file may say which exercise it answers
    const cJSON *id = cJSON_GetObjectItemCaseSensitive(root, "problem");
    if (cJSON_IsString(id) && strcmp(id->valuestring, p->id) != 0) {
        return hn_submission_refuse(v, NULL,
                                    "the submission says it answers problem '%.40s', this is '%s'",
                                    id->valuestring, p->id);
    }
    return 1;
}

/// The answer must be there; a first field of nearly its name is suggested.
static int check_answer(hn_verdict *v, const cJSON *root) {
    const char *answer = v->problem->answer, *found = root->child ? root->child->string : NULL;
    if (cJSON_GetObjectItemCaseSensitive(root, answer)) {
        return 1;
    }
    char hint[HN_GRADE_TEXT];
    if (found && hn_nearest_name(found, &answer, 1)) {
        snprintf(hint, sizeof hint, "rename '%.60s' to '%s'", found, answer);
    } else {
        snprintf(hint, sizeof hint, "as in {\"%s\": [[\"...\", ...], ...]}", answer);
    }
    return hn_submission_refuse(v, hint, "the field '%s' is missing%s", answer,
                                found ? "" : ": the object is empty");
}

/// Rows are lists of one length. Writes that length, or -1 when there is no row.
static int check_rows(hn_verdict *v, const cJSON *answer, int *columns) {
    const hn_exercise *p = v->problem;
    int i = 0;
    *columns = -1;
    for (const cJSON *row = answer->child; row; row = row->next) {
        i++;
        if (!cJSON_IsArray(row)) {
            return hn_submission_refuse(v, NULL,
                                        "row %d of '%s' is %s, expected a list of %d formulas", i,
                                        p->answer, kind_of(row), p->n_columns);
        }
        int n = cJSON_GetArraySize(row);
        if (*columns >= 0 && n != *columns) {
            return hn_submission_refuse(v, NULL,
                                        "row %d of '%s' has %d entries, the rows before have %d", i,
                                        p->answer, n, *columns);
        }
        *columns = n;
    }
    return 1;
}

/// Entries are texts; numbers and null are let through and graded as such.
static int check_entries(hn_verdict *v, const cJSON *answer) {
    for (const cJSON *row = answer->child; row; row = row->next) {
        for (const cJSON *m = row->child; m; m = m->next) {
            if (!cJSON_IsString(m) && !cJSON_IsNumber(m) && !cJSON_IsNull(m)) {
                return hn_submission_refuse(v, "write each entry as a text in quotes",
                                            "an entry of '%s' is %s, expected a formula in quotes",
                                            v->problem->answer, kind_of(m));
            }
        }
    }
    return 1;
}

/// Rows and columns of the answer; a matrix of the transposed shape is let through.
static int check_shape(hn_verdict *v, const cJSON *answer, int *transposed) {
    const hn_exercise *p = v->problem;
    int rows = cJSON_GetArraySize(answer), columns;
    if (!cJSON_IsArray(answer)) {
        return hn_submission_refuse(v, NULL, "'%s' is %s, expected a list of %d rows", p->answer,
                                    kind_of(answer), p->n_rows);
    }
    if (!check_rows(v, answer, &columns)) {
        return 0;
    }

    *transposed = rows == p->n_columns && columns == p->n_rows && rows != columns;
    if (!*transposed && (rows != p->n_rows || columns != p->n_columns)) {
        return hn_submission_refuse(v, "one row for each equation, one column for each coordinate",
                                    "'%s' has %d rows of %d entries, expected %d rows of %d",
                                    p->answer, rows, columns < 0 ? 0 : columns, p->n_rows,
                                    p->n_columns);
    }
    return check_entries(v, answer);
}

int hn_submission_read(hn_verdict *v, const cJSON *root, const cJSON **answer, int *transposed) {
    if (!cJSON_IsObject(root)) {
        return hn_submission_refuse(v, "as in {\"J\": [[\"...\", ...], ...]}",
                                    "the submission is %s, expected an object", kind_of(root));
    }
    *transposed = 0;
    *answer = cJSON_GetObjectItemCaseSensitive(root, v->problem->answer);
    return check_fields(v, root) && check_answer(v, root) && check_shape(v, *answer, transposed);
}
