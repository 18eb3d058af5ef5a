// SPDX-License-Identifier: GPL-3.0-or-later
// Files that include files: the same scene as with their text in place, and every way in which it
// cannot be.
#include "support/near.h"

#include "support/imported.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct file {
    const char *name, *text;
} file;

/// Files of a model by name; how many were asked for.
typedef struct folder {
    const file *files;
    int n, asked;
} folder;

static hn_status read_from(void *user, const char *name, size_t most, hn_strbuf *text,
                           hn_diag *diag) {
    folder *f = user;
    f->asked++;
    for (int i = 0; i < f->n; i++) {
        if (strcmp(f->files[i].name, name) == 0) {
            const size_t n = strlen(f->files[i].text);
            hn_strbuf_add_n(text, f->files[i].text, n < most + 1 ? n : most + 1);
            return HN_OK;
        }
    }
    return hn_diag_set(diag, HN_ERR_IO, NULL, NULL, "cannot read '%s'", name);
}

static hn_status open_model(folder *f, const char *text, hn_import **im, hn_diags *diags) {
    *diags = (hn_diags){0};
    const hn_import_source source = {
        .text = text, .n = strlen(text), .file = "main.xml", .read = read_from, .user = f};
    return hn_import_read(&source, im, diags);
}

#define ARM \
    "<body name='arm'><joint name='j' axis='0 1 0'/><geom class='bar' fromto='0 0 0 1 0 0'/>"
#define TIP "<body name='tip' pos='1 0 0'><joint name='k' axis='0 1 0'/><geom size='0.1'/></body>"
#define BAR "<default class='bar'><geom type='capsule' size='0.02' density='800'/></default>"

static const char WHOLE[] = "<mujoco model='m'><default>" BAR "</default><worldbody>" ARM TIP
                            "</body></worldbody><equality><connect body1='tip' anchor='0 0 0'/>"
                            "</equality></mujoco>";
static const char IN_PARTS[] =
    "<mujoco model='m'><include file='looks/defaults.xml'/><worldbody>" ARM
    "<include file='./parts//tip.xml'/></body></worldbody><include "
    "file='parts/loop.xml'/></mujoco>";
// names are relative to the model's folder in files of other folders, too, and the roots may have
// any name
static const file PARTS[] = {
    {"looks/defaults.xml", "<mujocoinclude><default><include file='looks/bar.xml'/></default>"
                           "</mujocoinclude>"},
    {"looks/bar.xml", "<anything>" BAR "</anything>"},
    {"parts/tip.xml", "<?xml version='1.0'?><!-- one body -->\n<mujoco>" TIP "</mujoco>"},
    {"parts/loop.xml",
     "<mujoco><equality><connect body1='tip' anchor='0 0 0'/></equality></mujoco>"}};

static void parts_make_the_same_scene_as_the_whole(void **state) {
    (void)state;
    folder f = {PARTS, 4, 0};
    hn_import *whole = NULL, *parts = NULL;
    hn_diags diags;
    size_t n, m;
    assert_int_equal(open_model(&f, WHOLE, &whole, &diags), HN_OK);
    if (open_model(&f, IN_PARTS, &parts, &diags) != HN_OK) {
        fail_msg("%s", diags.item[0].message);
    }
    assert_int_equal(f.asked, 4);
    const char *one = hn_import_scene(whole, &n), *two = hn_import_scene(parts, &m);
    assert_int_equal(n, m);
    assert_memory_equal(one, two, n);
    assert_int_equal(hn_import_get_info(parts).n_closing, 1);
    hn_import_free(parts);
    hn_import_free(whole);
}

static void notes_tell_the_file_they_stand_in(void **state) {
    (void)state;
    static const file files[] = {
        {"a.xml", "<mujoco>\n\n<size nconmax='3'/></mujoco>"},
        {"b.xml", "<mujoco>\n" TIP "<site name='s' rgba='1 0 0 1'/></mujoco>"}};
    folder f = {files, 2, 0};
    hn_import *im = NULL;
    hn_diags diags;
    const int ok = open_model(&f,
                              "<mujoco>\n<include file='a.xml'/><worldbody>\n<body><joint/>"
                              "<geom size='1' rgba='1 0 0 1'/><include file='b.xml'/></body>"
                              "</worldbody>\n<size/></mujoco>",
                              &im, &diags) == HN_OK;
    if (!ok) {
        fail_msg("%s", diags.item[0].message);
    }
    int own = 0, last = 0, n = hn_import_note_count(im);
    const char *before = NULL;
    for (int i = 0; i < n; i++) {
        const hn_import_note *note = hn_import_note_at(im, i);
        const int same = (before == NULL) == (note->file == NULL) &&
                         (!before || strcmp(before, note->file) == 0);
        assert_true(!same || note->line >= last); // by line within a file
        assert_true(!before || note->file);       // the model's own come first
        own += note->file == NULL;
        before = note->file;
        last = note->line;
    }
    assert_true(own >= 2 && own < n);
    const hn_import_note *size = NULL;
    for (int i = 0; i < n; i++) {
        const hn_import_note *note = hn_import_note_at(im, i);
        size = note->file && strcmp(note->file, "a.xml") == 0 ? note : size;
    }
    assert_non_null(size);
    assert_int_equal(size->line, 3);
    hn_import_free(im);
}

#define MODEL(inside) "<mujoco><worldbody>" ARM TIP "</body></worldbody>" BARS inside "</mujoco>"
#define BARS "<default>" BAR "</default>"

static const file BAD[] = {
    {"good.xml", "<mujoco/>"},
    {"one.xml", "<mujoco>\n<include file='two.xml'/></mujoco>"},
    {"two.xml", "<mujoco>\n\n<include file='./one.xml'/></mujoco>"},
    {"back.xml", "<mujoco><include file='main.xml'/></mujoco>"},
    {"self.xml", "<mujoco><include file='self.xml'/></mujoco>"},
    {"torn.xml", "<mujoco>\n<option>\n</mujoco>"},
    {"wrong.xml", "<mujoco>\n<option timestep='soon'/></mujoco>"},
    {"typed.xml", "<!DOCTYPE a [<!ENTITY b 'c'>]><mujoco/>"},
    {"empty.xml", ""},
    {"heir.xml", "<mujoco><option/>\n<include file='../x.xml'/></mujoco>"},
};

static const struct {
    const char *text, *says;
    hn_status status;
} ROWS[] = {
    {MODEL("<include/>"), "names no file", HN_ERR_INPUT},
    {MODEL("<include file=''/>"), "no file: ''", HN_ERR_INPUT},
    {MODEL("<include file='.'/>"), "no file: '.'", HN_ERR_INPUT},
    {MODEL("<include file='nowhere.xml'/>"), "cannot read 'nowhere.xml'", HN_ERR_IO},
    {MODEL("<include file='/etc/passwd'/>"), "not a file below", HN_ERR_INPUT},
    {MODEL("<include file='C:x.xml'/>"), "not a file below", HN_ERR_INPUT},
    {MODEL("<include file='a\\x.xml'/>"), "not a file below", HN_ERR_INPUT},
    {MODEL("<include file='../x.xml'/>"), "leads out", HN_ERR_INPUT},
    {MODEL("<include file='a/../../x.xml'/>"), "leads out", HN_ERR_INPUT},
    {MODEL("<include file='heir.xml'/>"), "heir.xml, line 2: '../x.xml' leads out", HN_ERR_INPUT},
    {MODEL("<include file='good.xml'/><include file='./good.xml'/>"),
     "'good.xml' is included already", HN_ERR_INPUT},
    {MODEL("<include file='one.xml'/>"),
     "two.xml, line 3: files include each other in a circle: "
     "one.xml > two.xml > one.xml",
     HN_ERR_INPUT},
    {MODEL("<include file='back.xml'/>"), "main.xml > back.xml > main.xml", HN_ERR_INPUT},
    {MODEL("<include file='self.xml'/>"), "self.xml > self.xml", HN_ERR_INPUT},
    {MODEL("<include file='torn.xml'/>"), "torn.xml, line 3, column", HN_ERR_INPUT},
    {MODEL("<include file='wrong.xml'/>"), "wrong.xml, line 2: 'soon' is not a number",
     HN_ERR_INPUT},
    {MODEL("<include file='typed.xml'/>"), "typed.xml, line 1: a document type", HN_ERR_INPUT},
    {MODEL("<include file='empty.xml'/>"), "empty.xml, line 1", HN_ERR_INPUT},
};

static void what_cannot_be_included_is_told_with_its_file_and_line(void **state) {
    (void)state;
    for (size_t i = 0; i < sizeof ROWS / sizeof *ROWS; i++) {
        folder f = {BAD, (int)(sizeof BAD / sizeof *BAD), 0};
        hn_import *im = NULL;
        hn_diags diags;
        const hn_status status = open_model(&f, ROWS[i].text, &im, &diags);
        assert_null(im);
        if (status != ROWS[i].status || !strstr(diags.item[0].message, ROWS[i].says)) {
            fail_msg("%s: %s, %s", ROWS[i].text, hn_status_name(status), diags.item[0].message);
        }
    }
}

/// File "k" includes "k+1"; or holds a lot of blanks.
typedef struct endless {
    size_t blanks;
    int asked;
} endless;

static hn_status read_endless(void *user, const char *name, size_t most, hn_strbuf *text,
                              hn_diag *diag) {
    endless *e = user;
    (void)diag;
    e->asked++;
    hn_strbuf_printf(text, "<mujoco>");
    for (size_t i = 0; i < e->blanks && text->n <= most; i++) {
        hn_strbuf_add(text, " ");
    }
    if (e->blanks == 0) {
        hn_strbuf_printf(text, "<include file='%d'/>", atoi(name) + 1);
    }
    hn_strbuf_add(text, "</mujoco>");
    return HN_OK;
}

static void depth_count_and_size_of_files_are_bounded(void **state) {
    (void)state;
    char many[4096] = "<mujoco>";
    for (int i = 0; i < HN_IMPORT_MAX_FILES; i++) {
        snprintf(many + strlen(many), sizeof many - strlen(many), "<include file='%d'/>", i);
    }
    strcat(many, "</mujoco>");
    const struct {
        const char *text, *says;
        size_t blanks;
        int asked;
    } rows[] = {{"<mujoco><include file='1'/></mujoco>", "more than 10 deep", 0,
                 HN_IMPORT_MAX_INCLUDES_DEEP},
                {many, "more than 64", 1, HN_IMPORT_MAX_FILES - 1},
                {"<mujoco><include file='1'/><include file='2'/></mujoco>", "4194304 bytes in all",
                 3 << 20, 2}};
    for (int i = 0; i < 3; i++) {
        endless e = {rows[i].blanks, 0};
        hn_import *im = NULL;
        hn_diags diags = {0};
        const hn_import_source source = {
            .text = rows[i].text, .n = strlen(rows[i].text), .read = read_endless, .user = &e};
        assert_int_equal(hn_import_read(&source, &im, &diags), HN_ERR_LIMIT);
        assert_non_null(strstr(diags.item[0].message, rows[i].says));
        assert_int_equal(e.asked, rows[i].asked);
    }
}

// each file is shallow enough by itself
static void elements_of_all_files_together_are_bounded_in_depth(void **state) {
    (void)state;
    enum { DEPTH = 60 };
    char deep[2048] = "", inner[2048] = "<mujoco>";
    strcat(deep, "<mujoco><worldbody>");
    for (int i = 0; i < DEPTH; i++) {
        strcat(deep, "<body>");
        strcat(inner, "<body>");
    }
    strcat(deep, "<include file='inner.xml'/>");
    for (int i = 0; i < DEPTH; i++) {
        strcat(deep, "</body>");
        strcat(inner, "</body>");
    }
    strcat(deep, "</worldbody></mujoco>");
    strcat(inner, "</mujoco>");
    const file files[] = {{"inner.xml", inner}};
    folder f = {files, 1, 0};
    hn_import *im = NULL;
    hn_diags diags;
    assert_int_equal(open_model(&f, deep, &im, &diags), HN_ERR_LIMIT);
    assert_non_null(strstr(diags.item[0].message, "inner.xml, line 1: elements are nested"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_make_the_same_scene_as_the_whole),
        cmocka_unit_test(notes_tell_the_file_they_stand_in),
        cmocka_unit_test(what_cannot_be_included_is_told_with_its_file_and_line),
        cmocka_unit_test(depth_count_and_size_of_files_are_bounded),
        cmocka_unit_test(elements_of_all_files_together_are_bounded_in_depth),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
