#pragma once

/// Seeds that the stand-in worker understands; with any other it behaves.
enum class Behaviour {
  behaves = 1,
  crashes = 101,
  crashes_once = 102,
  hangs = 103,
  refuses = 104,
  loses_device_once = 105,
  talks_nonsense = 106,
};
