// The program in time: a move and a part of it for every second.

const SPEEDS = [1, 4, 16, 64, 256, 1024, 4096];

export function playerOf(parts, acts) {
  const player = { ...parts, acts, at: 0, total: 0, times: null, going: false, last: 0 };
  for (const speed of SPEEDS) parts.speed.add(new Option(`${speed} ×`, speed));
  parts.time.addEventListener("input", () => goTo(player, Number(parts.time.value) * player.total));
  parts.play.addEventListener("click", () => toggle(player));
  return player;
}

export function setTimes(player, times) {
  player.times = times;
  player.total = times[times.length - 1];
  const speed = SPEEDS.find((each) => player.total / each <= 60) ?? SPEEDS[SPEEDS.length - 1];
  player.speed.value = speed;
  goTo(player, player.total);
}

// The row under way at a time, and how much of it is done.
export function rowAtTime(times, seconds) {
  let [low, high] = [0, times.length - 2];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle + 1] < seconds) low = middle + 1;
    else high = middle;
  }
  const size = times[low + 1] - times[low];
  return { row: low, part: size > 0 ? Math.min(1, Math.max(0, (seconds - times[low]) / size)) : 1 };
}

export function goTo(player, seconds) {
  player.at = Math.min(player.total, Math.max(0, seconds));
  player.time.value = player.total ? player.at / player.total : 1;
  player.clock.textContent = `${clock(player.at)} of ${clock(player.total)}`;
  player.acts.show(player.at);
}

function clock(seconds) {
  const whole = Math.floor(seconds);
  const two = (value) => String(value).padStart(2, "0");
  return `${Math.floor(whole / 3600)}:${two(Math.floor(whole / 60) % 60)}:${two(whole % 60)}`;
}

export function toggle(player) {
  player.going = !player.going;
  player.play.textContent = player.going ? "■" : "▶";
  if (!player.going) return;
  if (player.at >= player.total) goTo(player, 0);
  player.last = performance.now();
  requestAnimationFrame((now) => step(player, now));
}

function step(player, now) {
  if (!player.going) return;
  const seconds = Math.max(0, now - player.last) / 1000;
  player.last = now;
  goTo(player, player.at + seconds * Number(player.speed.value));
  if (player.at >= player.total) toggle(player);
  else requestAnimationFrame((later) => step(player, later));
}
