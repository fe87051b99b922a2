# SPDX-License-Identifier: GPL-3.0-or-later
# Completion of the programs of DilatedDEM for bash: options from --help, keys of a scene after "section." of --set and
# --explain, else files.  A new option needs nothing here.
_dilateddem()
{
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} program=${COMP_WORDS[0]}
    COMPREPLY=()
    case $prev in
    -s | --set | -e | --explain)
        if [[ ${program##*/} == dem-solve && $cur == *.* ]]; then
            mapfile -t COMPREPLY < <(compgen -W \
                "$("$program" --explain "${cur%.*}" 2>/dev/null | sed -n 's/^\([a-z_]*\.[a-z_0-9.]*\): .*/\1/p')" -- "$cur")
            if [[ $prev != -e && $prev != --explain ]]; then
                COMPREPLY=("${COMPREPLY[@]/%/=}")
                compopt -o nospace
            fi
            return
        fi
        ;;
    esac
    if [[ $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W \
            "$("$program" --help 2>/dev/null | sed -n 's/^  *\(-., \)\{0,1\}\(--[a-z][a-z0-9-]*\).*/\2/p')" -- "$cur")
    fi
}
complete -o default -F _dilateddem COMMANDS
