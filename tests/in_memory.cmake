# Run by ctest before the tests. What railcast writes is synced to the disk before it counts, for which small runs wait longer
# than they compute. Tests in Python, and the programs that they run, write into memory where it has room for all of them, as
# TemporaryDirectory of the tests in C++ does.
file(STRINGS /proc/mounts memory REGEX " /dev/shm tmpfs ")
if(memory AND NOT memory MATCHES "noexec" AND NOT DEFINED ENV{TMPDIR})
  execute_process(COMMAND df --output=avail --block-size=1M /dev/shm OUTPUT_VARIABLE table)
  string(REGEX MATCH "[0-9]+" free_mb "${table}")
  if(free_mb GREATER 4096)
    set(ENV{TMPDIR} /dev/shm)
  endif()
endif()
