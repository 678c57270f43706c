// A page that `millscope watch` serves asks for its data again and again, and says when nobody answers.

const EVERY = 3000; // ms between an answer and the next question
const PATIENCE = 10000; // ms for one answer
const SLOWEST = 30000; // ms between questions while nobody answers

const clock = (date) => date.toLocaleTimeString([], { hour12: false });

export function follow(write, banner) {
  let before = "";
  let answered = new Date();
  let wait = EVERY;

  const say = (text) => {
    if (banner.textContent !== text) banner.textContent = text;
    banner.hidden = text === "";
  };

  async function ask() {
    let text;
    try {
      const answer = await fetch(`data.json${location.search}`, { cache: "no-store", signal: AbortSignal.timeout(PATIENCE) });
      if (!answer.ok) throw new Error(`it answers ${answer.status}`);
      text = await answer.text();
    } catch (error) {
      const why = /answers/.test(error.message) ? ` (${error.message})` : "";
      say(`millscope watch no longer answers${why}. This page shows the state of ${clock(answered)} and goes on asking.`);
      wait = Math.min(SLOWEST, wait * 1.5);
      return true;
    }
    answered = new Date();
    wait = EVERY;
    if (text === before) {
      say("");
      return true;
    }
    try {
      const next = JSON.parse(text);
      write(next);
      before = text;
      say("");
      return next.live !== false;
    } catch (error) {
      say(`The data that millscope watch sends cannot be shown (${error.message}). This page shows an earlier state.`);
      return true;
    }
  }

  const again = () => setTimeout(async () => (await ask()) && again(), wait);
  again();
}
