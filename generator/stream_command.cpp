#include <signal.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <iostream>
#include <utility>

#include "core/base/error.h"
#include "core/io/velodyne/calibration_xml.h"
#include "core/io/write_file.h"
#include "core/scenario/effects.h"
#include "core/scenario/scenario.h"
#include "generator/chosen_fidelity.h"
#include "generator/commanded_run.h"
#include "generator/commands.h"
#include "generator/live/command_loop.h"
#include "generator/live/live_summary.h"
#include "generator/live/sensor_stream.h"
#include "generator/scenario_identity.h"
#include "generator/stop_signal.h"
#include "generator/terminal_line.h"
