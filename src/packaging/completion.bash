# Completion of `sprung` for bash. The help of the program that is completed tells its commands, options and their values.
_sprung() {
  local program=${1/#\~/$HOME} word=$2 before=$3 command=${COMP_WORDS[1]} help tag choices done=
  # bash takes the = of --format=obj for a word of its own.
  [[ $word == = ]] && word=
  [[ $before == = ]] && before=${COMP_WORDS[COMP_CWORD - 2]}
  COMPREPLY=()

  local commands
  commands=$("$program" help 2>/dev/null | sed -n '/^Subcommands:/,/^$/s/^  \([a-z]*\) .*/\1/p')
  if ((COMP_CWORD == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "$commands --help --version" -- "$word")
    return
  fi
  help=$("$program" help "$command" 2>/dev/null) || return

  # What describes the value: of the option before the word, or else of the arguments.
  if [[ $before == --* ]]; then tag=$(sed -n "s/^  $before \([A-Z][^ ]*\).*/\1/p" <<<"$help"); fi
  if [[ -z ${tag:-} ]]; then
    if [[ $word == -* ]]; then
      mapfile -t COMPREPLY < <(compgen -W "$(sed -n 's/^  \(-h,\)\{0,1\}\(--[a-z-]*\).*/\2/p' <<<"$help")" -- "$word")
      return
    fi
    tag=$(sed -n '/^Positionals:/,/^$/s/^  \([A-Z|]*\) .*/\1/p' <<<"$help")
  fi

  case $tag in
    *{*}*)
      choices=${tag#*\{}
      if [[ $word == *,* ]]; then done=${word%,*},; fi # a list: its last name is completed
      mapfile -t COMPREPLY < <(compgen -P "$done" -W "$(tr ',}' '  ' <<<"$choices")" -- "${word##*,}")
      ;;
    DIR)
      compopt -o filenames
      mapfile -t COMPREPLY < <(compgen -d -- "$word")
      ;;
    SCENE | 'SCENE|DIR' | MESH | FILE | PATH)
      compopt -o filenames
      local filter='' # a scene is a JSON file
      [[ $tag == SCENE* ]] && filter='!*.json'
      mapfile -t COMPREPLY < <(compgen -d -- "$word"; compgen -f -X "$filter" -- "$word" | while read -r file; do
        [[ -d $file ]] || printf '%s\n' "$file"
      done)
      ;;
    COMMAND) mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$word") ;;
    NAME) mapfile -t COMPREPLY < <(compgen -W "$("$program" materials 2>/dev/null | awk '/^[a-z]/ { print $1 }')" -- "$word") ;;
  esac
}
complete -F _sprung sprung
