/* SPDX-License-Identifier: GPL-3.0-or-later */
/* Models of bars and beams: what is read makes a chain and can be tested for mechanisms. */
#include "member/mechanism.h"
#include "member/member_chain.h"
#include "support/fuzz.h"

static int fuzz_one(const unsigned char *data, size_t n)
{
    fl_err err = {0};
    fl_member_model m = {0};
    fl_member_chain c = {0};
    int verdict = fuzz_verdict(fl_member_model_read(&m, fuzz_file(data, n), &err), &err);
    if (verdict != FUZZ_READ) return m.node_name.n ? FUZZ_BROKEN : verdict;
    verdict = fuzz_verdict(fl_member_check_mechanism(&m, &err), &err);
    int64_t pieces = 0;
    for (int32_t k = 0; k < m.member_name.n; k++) pieces += m.member[k].pieces;
    if (verdict == FUZZ_READ && pieces < 10000) {
        verdict = fuzz_verdict(fl_member_chain_make(&c, &m, 1.0, &err), &err);
        if (verdict == FUZZ_READ) fl_member_chain_forces(&c);
    }
    fl_member_chain_free(&c);
    fl_member_model_free(&m);
    return verdict;
}

int main(int argc, char **argv) { return fuzz_main(argc, argv, "members", fuzz_one); }
