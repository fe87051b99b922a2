/* SPDX-License-Identifier: GPL-3.0-or-later */
/* States of a stopped path, read into the path of two bars. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "member/path_state.h"
#include "support/fuzz.h"

static const char MODEL[] = "#members 1\nnode a -1 0 0 hinge\nnode b 1 0 0 hinge\nnode c 0 0 0.1 hinge\n"
                            "section s 1000 1 1 1\nmember 1 a c s 2\nmember 2 b c s 2\nfix a pinned\n"
                            "fix b pinned\nfix c y\nload c 0 0 -1\n";

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_text in = {0};
    fl_member_model m = {0};
    fl_member_chain c = {0};
    fl_path p = {0};
    fl_path_table t = {0};
    const fl_path_options o = fl_path_defaults();
    int rc = fl_text_open_bytes(&in, "model", MODEL, (int64_t)strlen(MODEL), &err);
    if (rc == 0) rc = fl_member_model_read_text(&m, &in, &err);
    fl_text_close(&in);
    if (rc == 0) rc = fl_member_chain_make(&c, &m, 1.0, &err);
    if (rc == 0) rc = fl_path_start(&p, &c, &o, &err);
    if (rc == 0) {
        fl_path_table_watch_loads(&t, &m);
        rc = fl_path_state_read(&p, &t, fuzz_file(data, n), &err);
    }
    fl_path_table_free(&t);
    fl_path_free(&p);
    fl_member_chain_free(&c);
    fl_member_model_free(&m);
    return fuzz_verdict(rc, &err);
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "path_state", fuzz_one); }
