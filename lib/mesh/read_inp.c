/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include "mesh/element_surface.h"
#include "mesh/frame_inp.h"
#include "mesh/inp_assembly.h"
#include "mesh/inp_elements.h"
#include "mesh/inp_nodes.h"
#include "mesh/inp_sets.h"
#include "mesh/read_inp.h"

static int is_keyword(const char *p)
{
    return p[0] == '*' && isalpha((unsigned char)p[1 + strspn(p + 1, " \t")]);
}

/* True if decks begin with the keyword at p. */
static int begins_deck(const char *p)
{
    static const char *const first[] = {"HEADING", "PREPRINT", "NODE",   "ELEMENT",
                                        "INCLUDE", "PART",     "RESTART"};
    p += 1 + strspn(p + 1, " \t");
    for (size_t k = 0; k < sizeof first / sizeof *first; k++) {
        const size_t n = strlen(first[k]);
        if (strncasecmp(p, first[k], n) == 0 && strchr(" \t,\r\n", p[n])) return 1;
    }
    return 0;
}

int fl_inp_is(const fl_bytes *b)
{
    const char *p = b->data;
    int alone = 1; /* only comments so far */
    for (; *p; p += strspn(p, "\r\n")) {
        p += strspn(p, " \t\r\n\f\v");
        if (strncasecmp(p, "*DIODORE", 8) == 0) return 0; /* another program with the same keywords */
        if (is_keyword(p)) return alone || begins_deck(p);
        alone &= p[0] == '\0' || p[0] == '*';
        p += strcspn(p, "\r\n");
    }
    return 0;
}

static int reject_keyword(fl_inp_model *r, fl_err *err)
{
    return fl_deck_fail(&r->line.deck, err,
                        "*%s is not read: export the deck with all nodes and elements written out",
                        r->line.word);
}

static int reject_ls_dyna(fl_inp_model *r, fl_err *err)
{
    return fl_inp_fail(&r->line, err,
                       "a deck of LS-DYNA is not read: export it as Abaqus, Nastran, Ansys or STL", "");
}

static const struct {
    const char *word;
    int (*read)(fl_inp_model *r, fl_err *err);
} KEYWORD[] = {{"NODE", fl_inp_node},
               {"ELEMENT", fl_inp_element},
               {"ELSET", fl_inp_elset},
               {"SURFACE", fl_inp_surface},
               {"SYSTEM", fl_inp_system},
               {"NGEN", fl_inp_ngen},
               {"ELGEN", fl_inp_elgen},
               {"BEAMSECTION", fl_inp_read_section},
               {"BEAMGENERALSECTION", fl_inp_read_section},
               {"FRAMESECTION", fl_inp_read_section},
               {"SOLIDSECTION", fl_inp_read_section},
               {"PART", fl_inp_begin_part},
               {"ENDPART", fl_inp_end_part},
               {"ASSEMBLY", fl_inp_assembly},
               {"INSTANCE", fl_inp_instance},
               {"ENDINSTANCE", fl_inp_end_instance},
               {"NCOPY", reject_keyword},
               {"ELCOPY", reject_keyword},
               {"NFILL", reject_keyword},
               {"NMAP", reject_keyword},
               {"PARAMETER", reject_keyword},
               {"SYMMETRICMODELGENERATION", reject_keyword},
               {"IMPORT", reject_keyword},
               {"KEYWORD", reject_ls_dyna}};

static int read_keywords(fl_inp_model *r, fl_err *err)
{
    int kind;
    while ((kind = fl_inp_next(&r->line, err)) > 0) {
        size_t k = 0;
        if (kind == 2) continue; /* data of an ignored keyword */
        if (fl_inp_split_keyword(&r->line, err)) return -1;
        if (r->frame) {
            const int used = fl_frame_inp_keyword(r, err);
            if (used < 0) return -1;
            if (used) continue;
        }
        while (k < sizeof KEYWORD / sizeof *KEYWORD && strcmp(r->line.word, KEYWORD[k].word) != 0) k++;
        if (k == sizeof KEYWORD / sizeof *KEYWORD && r->frame && fl_frame_inp_count_skipped(r)) return -1;
        if (k < sizeof KEYWORD / sizeof *KEYWORD && KEYWORD[k].read(r, err)) return -1;
    }
    if (kind == 0 && r->store == &r->part_defs)
        return fl_inp_fail(&r->line, err, "the deck ends inside a part", "");
    return kind;
}

int fl_inp_read(fl_surface *s, fl_bytes *b, const char *name, fl_import_options *opt, fl_err *err)
{
    fl_inp_model r = {.name = name};
    const char *path = fl_in_name(b->in);
    int rc = -1;
    fl_frame_inp frame = {.model = opt ? opt->frame : NULL};
    if (frame.model) r.frame = &frame;
    fl_inp_leave_part(&r);
    if (fl_elements_start(&r.e, path, err) || fl_elements_start(&r.part_defs, path, err) ||
        fl_element_sets_add_instance(&r.sets, (fl_instance){-1, 0, -1, 0, 0}, err) < 0)
        goto done;
    fl_deck_start(&r.line.deck, &r.e, b);
    if (read_keywords(&r, err) || fl_inp_place_unused_parts(&r, err)) goto done;
    if (r.extra_nodes)
        fl_bytes_note(b, "%d elements list more nodes than their type has; those behind were skipped",
                      r.extra_nodes);
    fl_elements_free(&r.part_defs); /* saves the memory of two more copies of a large deck */
    free(b->data);
    b->data = NULL;
    b->n = b->cap = 0;
    if (r.frame) {
        rc = fl_frame_inp_finish(&r, err);
        goto done;
    }
    if (fl_inp_apply_sections(&r, err) || fl_element_sets_export(&r.sets, &r.e, opt, err)) goto done;
    rc = fl_elements_surface(&r.e, s, b, opt, err);
done:
    fl_frame_inp_free(&frame);
    fl_inp_model_free(&r);
    return rc;
}
