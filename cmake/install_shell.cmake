# What shells and `man` read: written by the program when it is installed.
function(littoral_install_shell program manual data)
  set(prefix $ENV{DESTDIR}${CMAKE_INSTALL_PREFIX})
  set(bash ${prefix}/${data}/bash-completion/completions)
  set(zsh ${prefix}/${data}/zsh/site-functions)
  set(fish ${prefix}/${data}/fish/vendor_completions.d)
  file(MAKE_DIRECTORY ${prefix}/${manual} ${bash} ${zsh} ${fish})
  message(STATUS "Installing: ${prefix}/${manual}/littoral.1 and a page for each verb")
  execute_process(COMMAND ${program} help --man-pages ${prefix}/${manual}
                  COMMAND_ERROR_IS_FATAL ANY)
  foreach(shell bash zsh fish)
    set(file_bash ${bash}/littoral)
    set(file_zsh ${zsh}/_littoral)
    set(file_fish ${fish}/littoral.fish)
    message(STATUS "Installing: ${file_${shell}}")
    execute_process(COMMAND ${program} completion ${shell} OUTPUT_FILE ${file_${shell}}
                    COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endfunction()
