#include <stdio.h>

#include "railcast/c_api.h"

int main(void) {
  struct railcast_config config = {0};
  railcast_sim* sim = NULL;
  if (railcast_c_api_version() != RAILCAST_C_API_VERSION) return 1;
  if (railcast_create(&config, &sim) != RAILCAST_BAD_ARGUMENT || sim != NULL) return 1;
  puts("ok");
  return 0;
}
