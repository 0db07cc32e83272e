# Warnings and sanitizers for our own targets.
function(littoral_warnings target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor)
  if(CMAKE_UNITY_BUILD)
    # Joined files see each other's helpers; shadowing is judged where every file is compiled alone.
    target_compile_options(${target} PRIVATE -Wno-shadow)
  endif()
  if(LITTORAL_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(LITTORAL_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${LITTORAL_SANITIZE}
                           -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PUBLIC -fsanitize=${LITTORAL_SANITIZE})
  endif()
endfunction()
