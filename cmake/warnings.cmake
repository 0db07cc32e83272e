# Warnings and sanitizers for our own targets.
function(littoral_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  if(LITTORAL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(LITTORAL_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${LITTORAL_SANITIZE}
                           -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${LITTORAL_SANITIZE})
  endif()
endfunction()
