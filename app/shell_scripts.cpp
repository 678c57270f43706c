#include "app/shell_scripts.hpp"

namespace millscope::app {
namespace {

// Each asks `millscope complete` and passes on what it says; lines that begin with ':' ask for files, which the shell lists itself.

constexpr std::string_view kBash = R"script(# bash completion of millscope, written by 'millscope completion bash'
_millscope() {
  local program=${COMP_WORDS[0]/#\~/$HOME} current=${COMP_WORDS[COMP_CWORD]} line extension
  [[ $current == "=" ]] && current=
  COMPREPLY=()
  while IFS= read -r line; do
    case $line in
      :directory | :file*)
        compopt -o filenames 2>/dev/null
        while IFS= read -r; do COMPREPLY+=("$REPLY"); done < <(compgen -d -- "$current")
        if [[ $line == :file ]]; then
          COMPREPLY=()
          while IFS= read -r; do COMPREPLY+=("$REPLY"); done < <(compgen -f -- "$current")
        elif [[ $line == :file* ]]; then
          for extension in ${line#:file }; do
            while IFS= read -r; do COMPREPLY+=("$REPLY"); done < <(compgen -f -X "!*.$extension" -- "$current")
          done
        fi
        ;;
      *) COMPREPLY+=("${line%%$'\t'*}") ;;
    esac
  done < <("$program" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
}
complete -F _millscope millscope
)script";

constexpr std::string_view kZsh = R"script(#compdef millscope
# zsh completion of millscope, written by 'millscope completion zsh'
_millscope() {
  local line what
  local -a lines found extensions
  lines=("${(@f)$("${${(Q)words[1]}/#\~/$HOME}" complete -- "${(@Q)words[2,CURRENT]}" 2>/dev/null)}")
  for line in "${lines[@]}"; do
    case $line in
      '') ;;
      :directory) compset -P '--*='; _files -/ ;;
      :file) compset -P '--*='; _files ;;
      :file*) compset -P '--*='; extensions=(${=line#:file }); _files -g "*.(${(j:|:)extensions})" ;;
      *) what=${line#*$'\t'}; found+=("${${line%%$'\t'*}//:/\\:}${what:+:$what}") ;;
    esac
  done
  (( $#found )) && _describe millscope found
}
if [[ $funcstack[1] == _millscope ]]; then
  _millscope "$@"
else
  compdef _millscope millscope
fi
)script";

constexpr std::string_view kFish = R"script(# fish completion of millscope, written by 'millscope completion fish'
function __millscope_complete
    set -l words (commandline -opc)
    set -l current (commandline -ct)
    for line in ($words[1] complete -- $words[2..-1] "$current" 2>/dev/null)
        switch $line
            case ':directory'
                __fish_complete_directories "$current"
            case ':file'
                __fish_complete_path "$current"
            case ':file *'
                for extension in (string split ' ' -- (string replace ':file ' '' -- $line))
                    __fish_complete_suffix ".$extension"
                end
            case '*'
                echo $line
        end
    end
end
complete -c millscope -f -a '(__millscope_complete)'
)script";

}  // namespace

std::optional<std::string_view> shell_script(std::string_view shell) {
  if (shell == "bash") return kBash;
  if (shell == "zsh") return kZsh;
  if (shell == "fish") return kFish;
  return {};
}

}  // namespace millscope::app
