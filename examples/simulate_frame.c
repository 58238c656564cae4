// simulate_frame.c: counts what became of the firings of a scenario's first frames.
#include <railcast/c_api.h>
#include <stdio.h>

// Reads a whole file into `text`, which has room for `size` characters. Returns whether it fits.
static int ReadText(const char* path, char* text, size_t size) {
  FILE* file = fopen(path, "rb");
  if (!file) return 0;
  const size_t length = fread(text, 1, size, file);
  fclose(file);
  if (length == size) return 0;
  text[length] = '\0';
  return 1;
}

// Prints how many firings of the last step had each outcome.
static int PrintOutcomes(const railcast_sim* sim, uint32_t index) {
  int counts[256] = {0};
  railcast_field outcome;  // Points into the simulation's own memory until the next step.
  if (railcast_get_field(sim, "outcome", &outcome)) return 0;
  for (size_t slot = 0; slot < outcome.num_values; ++slot) {
    ++counts[((const uint8_t*)outcome.values)[slot]];
  }
  for (unsigned value = 0; value < 256; ++value) {
    if (counts[value] == 0) continue;
    printf("%u %s %d\n", (unsigned)index, railcast_outcome_name(value), counts[value]);
  }
  return 1;
}

int main(int argc, char** argv) {
  static char text[1 << 20];
  railcast_config config = {0};
  railcast_sim* sim = NULL;
  if (argc != 2) return 2;
  if (!ReadText(argv[1], text, sizeof text)) {
    fprintf(stderr, "%s: cannot be read\n", argv[1]);
    return 1;
  }
  config.json_text = text;
  config.file = argv[1];  // Names of other files in the scenario are relative to its folder.
  int is_good = railcast_create(&config, &sim) == RAILCAST_OK;
  for (uint32_t index = 0; is_good && index < 3; ++index) {
    is_good = railcast_step(sim, index) == RAILCAST_OK && PrintOutcomes(sim, index);
  }
  if (!is_good) fprintf(stderr, "%s\n", railcast_last_error());
  railcast_destroy(sim);
  return is_good ? 0 : 1;
}
