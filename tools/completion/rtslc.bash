# Completion of rtslc for bash: runs the program's --help, so that no option is missing.
_rtslc() {
  local current="${COMP_WORDS[COMP_CWORD]}" previous="${COMP_WORDS[COMP_CWORD-1]}"
  [[ $previous == "=" ]] && previous="${COMP_WORDS[COMP_CWORD-2]}"
  [[ $current == "=" ]] && current=""
  local program="${COMP_WORDS[0]}" command="${COMP_WORDS[1]}"
  if (( COMP_CWORD == 1 )) || [[ $command == help && $current != -* ]]; then
    local commands
    commands=$("$program" --help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
    (( COMP_CWORD == 1 )) && commands="$commands --help --version"
    mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
    return
  fi
  local help
  help=$("$program" "$command" --help 2>/dev/null)
  if (( COMP_CWORD == 2 )) && [[ $current != -* ]]; then
    # The first argument of `new` is one of a few words.
    local kinds
    kinds=$(sed -n 's/^ *KIND \([^ ]*|[^ ]*\).*/\1/p' <<< "$help" | tr '|' ' ')
    if [[ -n $kinds ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$kinds" -- "$current")
      return
    fi
  fi
  if [[ $previous == --* ]]; then
    # The values of an option follow it, separated by bars.
    local choices
    choices=$(sed -n "s/^ *\(-[a-zA-Z],\)\{0,1\}$previous \([^ :]*|[^ :]*\).*/\2/p" <<< "$help" | tr '|' ' ')
    if [[ -n $choices ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$choices" -- "$current")
      return
    fi
  fi
  if [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$(grep -oE -- '^ +(-[a-zA-Z],)?--[A-Za-z-]+' <<< "$help" | grep -oE -- '--[A-Za-z-]+')" -- "$current")
  fi
}
complete -o default -F _rtslc rtslc
