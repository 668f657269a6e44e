// Asks the server; what it refuses comes as an error with its own words.

export class Refused extends Error {}

export async function ask(path, options = {}) {
  let answer;
  try {
    answer = await fetch(path, options);
  } catch (error) {
    if (error.name === "AbortError") throw error;
    throw new Refused("the server does not answer; is afkb serve still running?");
  }
  if (answer.ok) return answer;
  const text = await answer.text();
  let told = text;
  try {
    told = JSON.parse(text).error || text;
  } catch { /* It is plain text, then. */ }
  const later = answer.headers.get("Retry-After");
  throw new Refused(`${told || answer.statusText}${later ? ` (again in ${later} s)` : ""}`);
}

export const askJson = async (path) => (await ask(path)).json();
