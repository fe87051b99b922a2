/* SPDX-License-Identifier: GPL-3.0-or-later */
#include <stddef.h>
#include <string.h>
#include <strings.h>
#include "mesh/rejected_formats.h"

enum { SEARCHED_LINES = 40 }; /* searched for a line of the table */

#define SOLIDS "geometry without a mesh: mesh it in its program or in Gmsh, and export STL or MSH"
#define GMSH                                                                                                 \
    "geometry without a mesh: gmsh FILE -2 -setstring Geometry.OCCTargetUnit M -clmax 0.5 -clcurv 40 "       \
    "-format msh41 -o hull.msh makes one in metres"
#define PANELS "export the panels as WAMIT GDF or STL"
#define SURFACE "export the surface as STL, OBJ or PLY"
#define DECK "export the mesh as Abaqus, Nastran, VTK or STL"

/* First bytes of a format, behind blanks in a text. */
static const struct {
    const char *begins;
    size_t n; /* number of bytes, 0 for all up to the zero byte */
    const char *what;
} FIRST_BYTES[] = {
    {"ISO-10303-21", 0, "a STEP file, which is " GMSH},
    {"DBRep_DrawableShape", 0, "a BREP file, which is " GMSH},
    {"CASCADE Topology", 0, "a BREP file, which is " GMSH},
    {"**ABCDEFGHIJKLMNOPQRSTUVWXYZ", 0, "a Parasolid file, which is " SOLIDS},
    {"glTF", 0, "a glTF scene: " SURFACE},
    {"Kaydara FBX", 0, "an FBX scene: " SURFACE},
    {"PK\003\004", 4, "a ZIP archive, as 3MF is: unpack it, or " SURFACE},
    {"\211HDF\r\n", 6, "an HDF5 file, as MED and CGNS are: in Salome export the mesh as STL or DAT"},
    {"CDF\001", 4, "a NetCDF file, as Exodus is: " DECK},
    {"CDF\002", 4, "a NetCDF file, as Exodus is: " DECK},
    {"MeshVersionFormatted", 0, "a MEDIT mesh: " DECK},
    {"MeshVersionUnformatted", 0, "a MEDIT mesh: " DECK},
    {"#RADIOSS", 0, "a deck of Radioss: " DECK},
    {"#VRML", 0, "a VRML scene: " PANELS},
    {"%YAML", 0, "a YAML file, as OrcaFlex and OrcaWave write: " PANELS},
    {"3D Geometry File", 0, "a Rhino file, which is " SOLIDS},
    {"version https://git-lfs", 0,
     "a pointer of Git LFS to the file, and not the file: git lfs pull brings it"},
    {"\377\376", 2, "text in UTF-16: save it as UTF-8 or ASCII"},
    {"\376\377", 2, "text in UTF-16: save it as UTF-8 or ASCII"},
    {"%PDF", 0, "a PDF document, where a mesh is expected"},
};

/* A line near the beginning of a format. */
static const struct {
    const char *line, *what;
} FIRST_LINES[] = {
    {"*KEYWORD", "a deck of LS-DYNA: export it as Abaqus, Nastran, Ansys or STL"},
    {"*DIODORE", "a DIODORE file: " PANELS},
    {"&DIMEN", "commands of MOSES: " PANELS},
    {"&MODEL_DEF", "commands of MOSES: " PANELS},
    {"&DESCRIBE", "commands of MOSES: " PANELS},
    {"/PREP7", "commands of ANSYS without NBLOCK or EBLOCK: write the mesh with CDWRITE,DB,,,,,,BLOCKED"},
};

static const char *skip_blanks(const char *p) { return p + strspn(p, " \t\r\n"); }

/* Start of the line after p, or the end. */
static const char *next_line(const char *p)
{
    p += strcspn(p, "\n");
    return *p ? p + 1 : p;
}

/* True if the line at p is this word alone. */
static int is_line(const char *p, const char *word)
{
    p += strspn(p, " \t");
    return strncasecmp(p, word, strlen(word)) == 0 && strchr(" \t\r\n,", p[strlen(word)]) != NULL;
}

/* Section letter S in column 73 of lines of eighty characters. */
static int is_iges(const char *p) { return strcspn(p, "\r\n") >= 80 && p[72] == 'S' && p[79] == '1'; }

/* "(0 "comment")" or "(2 3)". */
static int is_fluent(const char *p)
{
    return p[0] == '(' && p[1] >= '0' && p[1] <= '2' && p[2] == ' ' && (p[3] == '"' || p[3] == '3');
}

/* Line 2 is one number and ILOWHICSF. */
static int is_control_surface(const char *p)
{
    p = next_line(p);
    const char *end = p + strcspn(p, "\n");
    for (; p < end; p++)
        if (strncasecmp(p, "ILOWHICSF", 9) == 0) return 1;
    return 0;
}

const char *fl_rejected_format(const fl_bytes *b)
{
    const char *text = skip_blanks(b->data), *p = b->data;
    for (size_t k = 0; k < sizeof FIRST_BYTES / sizeof *FIRST_BYTES; k++) {
        const size_t n = FIRST_BYTES[k].n ? FIRST_BYTES[k].n : strlen(FIRST_BYTES[k].begins);
        if ((size_t)(b->data + b->n - text) >= n && memcmp(text, FIRST_BYTES[k].begins, n) == 0)
            return FIRST_BYTES[k].what;
    }
    if (is_iges(b->data)) return "an IGES file, which is " GMSH;
    if (is_fluent(text)) return "a mesh of Fluent: " DECK;
    if (is_line(text, "0") && is_line(next_line(text), "SECTION")) return "a DXF drawing: " SURFACE;
    if (is_line(text, "-1")) return "a universal file of I-DEAS without datasets 2411 and 2412: " DECK;
    if (is_control_surface(b->data))
        return "a control surface of WAMIT, and no hull: read the geometric data file (.gdf)";
    if (*text == '{' && strstr(text, "\"asset\"")) return "a glTF scene: " SURFACE;
    for (int line = 0; line < SEARCHED_LINES && *p; line++, p = next_line(p))
        for (size_t k = 0; k < sizeof FIRST_LINES / sizeof *FIRST_LINES; k++)
            if (is_line(p, FIRST_LINES[k].line)) return FIRST_LINES[k].what;
    return NULL;
}
